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
  } // namespace

  Texts
  SweepInputs::attributes() const
  {
    return {{effective_name, effective}, {scenes_name, as_json(scenes)}, {files_name, as_json(files)}};
  }

  SweepInputs
  SweepInputs::from_attributes(const Texts &attributes)
  {
    const auto parsed = [&](const std::string &name) {
      auto json = nlohmann::json::parse(attributes.at(name), nullptr, /*allow_exceptions=*/false);
      if (!json.is_object() && !json.is_null())
        throw InputError("the attribute \"" + name + "\" of the table is damaged: JSON is expected");
      return json;
    };
    return {attributes.at(effective_name), parsed(scenes_name), parsed(files_name)};
  }

  SweepInputs
  sweep_inputs(const SweepPoints &points)
  {
    SweepInputs inputs{without_comments(points.effective()), {}, {}};
    const auto add_file = [&](const std::string &name) {
      std::error_code ignored;
      if (!name.empty() && !inputs.files.contains(name) && std::filesystem::is_regular_file(name, ignored))
        inputs.files.emplace(name, fingerprint(name));
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
        inputs.scenes[name].emplace(one.path, "\"" + one.value + "\"");
        if (found == base.end() || naming_files.contains(one.path))
          add_file(std::filesystem::absolute(one.folder / one.value).lexically_normal().string());
      }
    }
    return inputs;
  }

  std::vector<std::string>
  differences(const SweepInputs &before, const SweepInputs &now, const std::vector<std::string> &free_entries)
  {
    std::vector<std::string> list;
    try
    {
      list = differences(before.effective, now.effective, free_entries);
    }
    catch (const InputError &) // the message may contain bytes that no terminal can show
    {
      throw InputError("the parameters that are kept in the table cannot be read: it is damaged, or from another "
                       "version of crawler; an intact one is expected");
    }
    const auto scene_in = [](const SweepInputs &inputs, const std::string &name) {
      const auto found = inputs.scenes.find(name);
      return found == inputs.scenes.end() ? Texts() : found->second;
    };
    auto all = before.scenes;
    all.insert(now.scenes.begin(), now.scenes.end());
    for (const auto &[name, ignored] : all)
      add_differences(scene_in(before, name), scene_in(now, name), "{} in " + name, "not set", list);
    add_differences(before.files, now.files, "the file \"{}\"", "not there", list);
    return list;
  }
} // namespace crawler
