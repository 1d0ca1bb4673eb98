// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/table/measured_table.h>
#include <crawler/studies/table/noisy_copies.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iterator>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr unsigned int least_points = 4, least_copies = 8;

    void
    require_sound(const TableOptions &options)
    {
      const PreparationSettings &p = options.preparation;
      for (const auto &[name, value] : {std::pair{"--smooth-s", p.width_s}, std::pair{"--smooth-t", p.width_t}})
        if (!(value >= 0.) || !std::isfinite(value))
          throw InputError(fmt::format("\"{}\" is {:g}, but a width of 0 or more is expected", name, value));
      for (const auto &[name, value] : {std::pair{"--points-s", p.n_s}, std::pair{"--points-t", p.n_t}})
        if (value > 0 && value < least_points)
          throw InputError(fmt::format("\"{}\" is {}, but at least {} points are expected", name, value, least_points));
      if (p.noise && !(*p.noise >= 0. && std::isfinite(*p.noise)))
        throw InputError(
          fmt::format("\"--noise\" is {:g}, but a standard deviation of 0 or more is expected", *p.noise));
      if (p.length && !(*p.length > 0. && std::isfinite(*p.length)))
        throw InputError(fmt::format("\"--length\" is {:g}, but a positive length is expected", *p.length));
      if (p.ends != "hold" && p.ends != "linear")
        throw InputError(fmt::format("\"--ends\" is \"{}\", but \"hold\" or \"linear\" is expected", p.ends));
      if (p.n_cycles == 0 || (p.n_cycles > 1 && p.period.empty()))
        throw InputError(
          fmt::format("\"--cycles\" is {}, but a number of cycles of \"--period\" is expected", p.n_cycles));
      if (options.n_copies < least_copies)
        throw InputError(
          fmt::format("\"--copies\" is {}, but at least {} are expected", options.n_copies, least_copies));
      if (fs::path(options.output).extension() != ".csv")
        throw InputError(
          fmt::format("the table is to be \"{}\", but a name that ends in .csv is expected", options.output));
      std::error_code ignored;
      if (fs::equivalent(options.input, options.output, ignored))
        throw InputError(
          fmt::format("\"{}\" is to be read and written, but another name for the table is expected", options.output));
      if (!options.overwrite && fs::exists(options.output, ignored))
        throw InputError(fmt::format("\"{}\" exists; another name or \"--overwrite\" is expected", options.output));
    }

    /// The samples as measured, in the units of the table.
    std::string
    before_text(const Samples &samples)
    {
      std::string text = fmt::format(
        "{},t,{}\n", samples.quantity == MeasuredQuantity::marker ? "marker" : "s", column_of(samples.quantity));
      for (std::size_t j = 0; j < samples.t.size(); ++j)
        for (std::size_t i = 0; i < samples.s.size(); ++i)
          if (!std::isnan(samples.at(j, i)))
            fmt::format_to(
              std::back_inserter(text), "{:.10g},{:.10g},{:.10g}\n", samples.s[i], samples.t[j], samples.at(j, i));
      return text;
    }

    std::string
    uncertainty(const TableOptions &options, const Samples &samples, const PreparedTable &table, Log &log)
    {
      ParameterFile scene = ParameterFile::read(options.scene);
      for (const std::string &assignment : options.overrides)
        scene.add_override(assignment);
      WaitProgress progress(log, fmt::format("{} noisy copies are computed", options.n_copies));
      const NoisyDisplacement found = noisy_displacement(
        samples, options.preparation, table, scene, options.n_copies, options.seed, [&]() { progress.step(); });
      return fmt::format(
        "displacement {:.8g} +- {} (numerical bound) +- {:.2g} (standard deviation by noise of {:.3g}, {} "
        "copies, known to {:.0f} %; their mean is {:.8g})",
        found.displacement,
        found.bound ? fmt::format("{:.1e}", *found.bound) : "?",
        found.deviation,
        table.noise,
        found.n_copies,
        100. / std::sqrt(2. * (found.n_copies - 1)),
        found.mean);
    }
  } // namespace

  void
  make_table(const TableOptions &options)
  {
    require_sound(options);
    Log log(/*is_first_rank=*/true, options.quiet);
    const MeasuredFile file        = read_measured_file(read_whole_file(options.input), options.input);
    std::vector<std::string> words = file.words;
    const Samples samples          = read_samples(file, options.samples, words);
    const PreparedTable table      = prepare_table(samples, options.preparation);
    words.insert(words.end(), table.words.begin(), table.words.end());
    if (!options.preparation.noise)
      words.push_back(
        fmt::format("noise of a sample, as estimated from third differences in time: {:.3g}", table.noise));
    if (!options.scene.empty())
      words.push_back(uncertainty(options, samples, table, log));
    const GridTable &grid = table.grid;
    words.push_back(fmt::format("table of {} at {} places, s = {:g} to {:g}, and {} times, t = {:g} to {:.10g}",
                                column_of(table.quantity),
                                grid.s.size(),
                                grid.s.front(),
                                grid.s.back(),
                                grid.t.size(),
                                grid.t.front(),
                                grid.t.back()));
    const fs::path stem = fs::path(options.output).replace_extension();
    std::string report  = fmt::format("{} -> {}\n", options.input, options.output);
    for (const std::string &sentence : words)
      report += "  " + sentence + "\n";
    write_file(stem.string() + "_before.csv", before_text(samples));
    write_file(stem.string() + "_report.txt", report);
    write_file(options.output, table_text(table));
    report.pop_back();
    log.line(report);
    log.line(fmt::format(
      "Picture: crawler plot {}. In the parameter file: {}",
      options.output,
      table.quantity == MeasuredQuantity::strain
        ? "Generator = prescribed strain, Given by = table, File = " + options.output
        : fmt::format("Generator = table, File = {}{}", options.output, table.period ? ", Outside = periodic" : "")));
  }
} // namespace crawler
