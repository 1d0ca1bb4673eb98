// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/parameters/plain_text.h>
#include <crawler/studies/run/field_runs.h>

#include <utility>

namespace crawler
{
  FieldRuns::FieldRuns(ParameterFile file, std::vector<std::string> paths)
    : paths_(std::move(paths))
    , form_(file)
    , input_(read_input(std::move(file), /*command=*/"fit"))
  {
  }

  void
  FieldRuns::take(const std::vector<double> &numbers)
  {
    for (std::size_t i = 0; i < paths_.size(); ++i)
      form_.declarations.set(paths_[i], to_text(numbers.at(i)));
    Parameters &parameters           = input_.parameters;
    parameters                       = form_.parameters;
    parameters.error_estimate        = false;
    parameters.output.energy_balance = false;
    input_.scene                     = parameters.create_scene();
  }

  RunInMemory
  FieldRuns::run(const std::vector<double> &numbers,
                 const bool is_similar,
                 const std::function<WantedFields(const Scene &)> &fields_wanted,
                 const std::function<void()> &start,
                 const std::function<bool()> &interrupted)
  {
    input_.file.placing_errors([&]() { take(numbers); });
    if (!is_similar || !model_)
    {
      model_    = choose_model(input_);
      numerics_ = std::nullopt;
    }
    if (model_->needs_mesh())
      start();
    WantedFields wanted = fields_wanted(input_.scene);
    wanted.is_all       = true;
    wanted.numerics     = numerics_;
    RunInMemory run     = run_in_memory(input_, *model_, wanted, interrupted);
    if (!numerics_)
      numerics_ = run.numerics;
    return run;
  }
} // namespace crawler
