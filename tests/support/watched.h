// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace crawler::test
{
  /// Observers, one in number, that show each snapshot of a run to @p see.
  inline std::vector<std::unique_ptr<Observer>>
  watched_by(std::function<void(const Snapshot &)> see)
  {
    class Watcher : public Observer
    {
    public:
      explicit Watcher(std::function<void(const Snapshot &)> see)
        : see_(std::move(see))
      {
      }
      void
      observe(const Snapshot &snapshot) override
      {
        see_(snapshot);
      }

    private:
      const std::function<void(const Snapshot &)> see_;
    };
    std::vector<std::unique_ptr<Observer>> observers;
    observers.push_back(std::make_unique<Watcher>(std::move(see)));
    return observers;
  }
} // namespace crawler::test
