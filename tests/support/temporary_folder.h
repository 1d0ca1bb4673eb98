// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/files.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace crawler::test
{
  /// Empty folder that is removed with this object.
  class TemporaryFolder
  {
  public:
    explicit TemporaryFolder(const std::filesystem::path &parent = std::filesystem::temp_directory_path())
    {
      std::string name = (parent / "crawler_test_XXXXXX").string();
      if (mkdtemp(name.data()) == nullptr)
        throw std::runtime_error("cannot make a temporary folder");
      path = name;
    }
    TemporaryFolder(const TemporaryFolder &) = delete;
    ~TemporaryFolder()
    {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }

    std::filesystem::path path;
  };
} // namespace crawler::test
