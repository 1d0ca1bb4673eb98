// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/entry_store.h>

#include <deal.II/base/parameter_handler.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    using dealii::ParameterHandler;

    /// What deal.II calls the values of an entry, so that parameter_gui has the right field for them; empty if it has
    /// no word for them.
    std::string
    dealii_words(const EntryValues &values)
    {
      namespace Patterns = dealii::Patterns;
      if (values.may_be_automatic)
        return "";
      const auto bound = [](const double x) { return static_cast<int>(std::min(x, 2147483647.)); };
      switch (values.kind)
      {
        case EntryKind::number:
          return Patterns::Double(values.range.lower, values.range.upper).description();
        case EntryKind::whole_number:
          return Patterns::Integer(bound(values.range.lower), bound(values.range.upper)).description();
        case EntryKind::choice:
          return Patterns::Selection(fmt::format("{}", fmt::join(values.words, "|"))).description();
        case EntryKind::flag:
          return Patterns::Bool().description();
        default:
          return "";
      }
    }

    /// A pattern that says in words what it expects.
    class WordyPattern : public dealii::Patterns::PatternBase
    {
    public:
      WordyPattern(std::string expected, std::string machine_words, std::function<bool(const std::string &)> match)
        : expected_(std::move(expected))
        , machine_words_(std::move(machine_words))
        , match_(std::move(match))
      {
      }
      bool
      match(const std::string &text) const override
      {
        return match_(text);
      }
      std::string
      description(const OutputStyle style) const override
      {
        return style == Machine && !machine_words_.empty() ? machine_words_ : expected_;
      }
      std::unique_ptr<PatternBase>
      clone() const override
      {
        return std::make_unique<WordyPattern>(*this);
      }

    private:
      std::string expected_, machine_words_;
      std::function<bool(const std::string &)> match_;
    };

    /// Runs @p action in the section of the entry @p path.
    template <typename Action>
    auto
    in_section(ParameterHandler &handler, const EntryStore::Path &path, const Action &action)
    {
      struct Sections
      {
        Sections(ParameterHandler &handler, const EntryStore::Path &path)
          : handler(handler)
          , depth(path.size() - 1)
        {
          for (std::size_t i = 0; i < depth; ++i)
            handler.enter_subsection(path[i]);
        }
        ~Sections()
        {
          for (std::size_t i = 0; i < depth; ++i)
            handler.leave_subsection();
        }
        ParameterHandler &handler;
        const std::size_t depth;
      };
      const Sections inside(handler, path);
      return action(path.back());
    }
  } // namespace

  struct EntryStore::Implementation
  {
    ParameterHandler handler;
  };

  EntryStore::EntryStore()
    : implementation_(std::make_unique<Implementation>())
  {
  }

  EntryStore::~EntryStore() = default;

  void
  EntryStore::declare(const Path &path,
                      const EntryInfo &info,
                      const std::function<bool(const std::string &)> &match,
                      const std::function<void(const std::string &)> &assign)
  {
    const std::string unit = info.unit.empty() ? "" : " Unit: " + info.unit + ".";
    in_section(implementation_->handler, path, [&](const std::string &name) {
      implementation_->handler.declare_entry(name,
                                             info.default_value,
                                             WordyPattern(info.expected, dealii_words(info.values), match),
                                             info.documentation + " Expected: " + info.expected + "." + unit);
      implementation_->handler.add_action(name, assign);
    });
  }

  bool
  EntryStore::set(const Path &path, const std::string &text)
  {
    return in_section(implementation_->handler, path, [&](const std::string &name) {
      try
      {
        implementation_->handler.set(name, text);
        return true;
      }
      catch (const ParameterHandler::ExcValueDoesNotMatchPattern &)
      {
        return false;
      }
    });
  }

  std::string
  EntryStore::get(const Path &path) const
  {
    return in_section(
      implementation_->handler, path, [&](const std::string &name) { return implementation_->handler.get(name); });
  }

  void
  EntryStore::print_prm(std::ostream &out) const
  {
    implementation_->handler.print_parameters(out, ParameterHandler::PRM | ParameterHandler::KeepDeclarationOrder);
  }

  void
  EntryStore::print_xml(std::ostream &out) const
  {
    implementation_->handler.print_parameters(out, ParameterHandler::XML | ParameterHandler::KeepDeclarationOrder);
  }
} // namespace crawler
