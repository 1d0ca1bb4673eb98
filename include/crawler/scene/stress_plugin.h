// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Complete interface for a plug-in of the generator "library" (doc/generators/library.md). It needs only C++20.
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/plugin_version.h>

#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace crawler
{
  /// The user's own parameters, from the entry Active stress/Library/Parameters.
  class PluginParameters
  {
  public:
    explicit PluginParameters(std::map<std::string, std::string> values)
      : values_(std::move(values))
    {
    }

    /// The parameter as a number, @p otherwise if it is not set. Throws std::invalid_argument if it is not a number.
    double
    number(const std::string &name, const double otherwise) const
    {
      known_.insert(name);
      const auto found = values_.find(name);
      if (found == values_.end())
        return otherwise;
      const std::string &text = found->second;
      double value            = 0.;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw std::invalid_argument("the parameter \"" + name + "\" is \"" + text + "\", but a number is expected");
      return value;
    }

    /// The parameter as written, @p otherwise if it is not set.
    std::string
    text(const std::string &name, const std::string &otherwise) const
    {
      known_.insert(name);
      const auto found = values_.find(name);
      return found == values_.end() ? otherwise : found->second;
    }

    /// Parameters that are set.
    const std::map<std::string, std::string> &
    values() const
    {
      return values_;
    }

    /// Names that the plug-in has asked for: any other that is set is a slip of the user.
    const std::set<std::string> &
    known() const
    {
      return known_;
    }

  private:
    std::map<std::string, std::string> values_;
    mutable std::set<std::string> known_;
  };

  /// Scene data for a plug-in, in the units of the parameter file.
  struct PluginInput
  {
    double length;               ///< L [length]
    double elastic_modulus;      ///< k [force]
    double friction_coefficient; ///< gamma [force time/length^2]
    double anchoring_exponent;   ///< p [1]
    double end_time;             ///< T [time]
    PluginParameters parameters;
  };

  /// Description of a plug-in. The first two members stay in place in all versions.
  struct Plugin
  {
    unsigned int interface;      ///< plugin_interface
    const char *crawler_version; ///< plugin_version
    const char *name;            ///< of the generator, for the log
    std::unique_ptr<ActiveStress> (*create)(const PluginInput &);
  };

  /// Interface version: grows by 1 whenever a header that a plug-in includes changes.
  inline constexpr unsigned int plugin_interface = 6;

  /// Name of the function that CRAWLER_ACTIVE_STRESS_PLUGIN exports.
  inline constexpr const char *plugin_function = "crawler_active_stress_plugin";
} // namespace crawler

/**
 * Makes a shared object a plug-in: once, outside of all namespaces. @p name is text in quotes, @p create a function
 * std::unique_ptr<crawler::ActiveStress>(const crawler::PluginInput &). It may throw: the user sees the message.
 */
#define CRAWLER_ACTIVE_STRESS_PLUGIN(name, create)                                                            \
  extern "C" __attribute__((visibility("default"))) const crawler::Plugin *crawler_active_stress_plugin()     \
  {                                                                                                           \
    static const crawler::Plugin plugin = {crawler::plugin_interface, crawler::plugin_version, name, create}; \
    return &plugin;                                                                                           \
  }
