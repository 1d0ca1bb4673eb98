// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep_inputs.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>

namespace crawler
{
  namespace
  {
    using Texts = std::map<std::string, std::string>;

    const std::string effective_name = "parameters.prm", scenes_name = "scene files", files_name = "data files";

    std::string
    as_json(const nlohmann::json &json)
    {
      return json.dump(-1, ' ', /*ensure_ascii=*/false, nlohmann::json::error_handler_t::replace);
    }

    nlohmann::json
    parsed(const SweepInputs &inputs, const std::string &name)
    {
      const auto found = inputs.find(name);
      auto json =
        nlohmann::json::parse(found != inputs.end() ? found->second : "{}", nullptr, /*allow_exceptions=*/false);
      if (!json.is_object())
        throw InputError("the attribute \"" + name + "\" of the table is damaged: JSON is expected");
      return json;
    }
  } // namespace

  SweepInputs
  sweep_inputs(const SweepPoints &points)
  {
    std::map<std::string, Texts> scenes;
    Texts files;
    const auto add_file = [&](const std::string &name) {
      std::error_code ignored;
      if (!name.empty() && !files.contains(name) && std::filesystem::is_regular_file(name, ignored))
        files.emplace(name, fingerprint(name));
    };
    Texts base;
    std::set<std::string> naming_files;
    for (unsigned int i = 0; i < points.declarations().entries().size(); ++i)
    {
      const EntryInfo &entry  = points.declarations().entries()[i];
      const std::string value = points.declarations().value(i);
      base.emplace(entry.path, value);
      if (!entry.names_file)
        continue;
      naming_files.insert(entry.path);
      if (!points.design().varies(entry.path))
        add_file(value);
      for (const SweepAxis &axis : points.design().axes())
        if (axis.entry == entry.path)
          for (const std::string &one : axis.values)
            add_file((points.design().folder() / one).string());
    }
    for (const std::string &name : points.scene_names())
    {
      const ParameterFile scene = points.scene(name);
      for (const Assignment &one : scene.assignments())
      {
        const auto found = base.find(one.path);
        if (points.design().varies(one.path) || (found != base.end() && found->second == one.value))
          continue;
        scenes[name].emplace(one.path, "\"" + one.value + "\"");
        if (found == base.end() || naming_files.contains(one.path))
          add_file(std::filesystem::absolute(one.folder / one.value).lexically_normal().string());
      }
    }
    return {{effective_name, without_comments(points.effective())},
            {scenes_name, as_json(scenes)},
            {files_name, as_json(files)}};
  }

  std::vector<std::string>
  differences(const SweepInputs &before, const SweepInputs &now, const std::vector<std::string> &free_entries)
  {
    std::vector<std::string> list;
    try
    {
      list = differences(before.at(effective_name), now.at(effective_name), free_entries);
    }
    catch (const InputError &) // the message may contain bytes that no terminal can show
    {
      throw InputError("the parameters that are kept in the table cannot be read: it is damaged, or from another "
                       "version of crawler; an intact one is expected");
    }
    std::map<std::string, Texts> scenes = parsed(before, scenes_name), scenes_now = parsed(now, scenes_name);
    for (const auto &[name, ignored] : scenes_now)
      scenes.try_emplace(name);
    for (const auto &[name, entries] : scenes)
      add_differences(entries, scenes_now[name], "{} in " + name, "not set", list);
    add_differences(parsed(before, files_name), parsed(now, files_name), "the file \"{}\"", "not there", list);
    return list;
  }
} // namespace crawler
