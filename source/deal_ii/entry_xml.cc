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

    /// A pattern that says in words what it expects. The texts have been looked at before.
    class WordyPattern : public dealii::Patterns::PatternBase
    {
    public:
      explicit WordyPattern(const EntryInfo &info)
        : expected_(info.expected)
        , machine_words_(dealii_words(info.values))
      {
      }
      bool
      match(const std::string &) const override
      {
        return true;
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
    };
  } // namespace
} // namespace crawler

extern "C" void
crawler_print_xml(std::ostream &out, const std::vector<crawler::StoredEntry> &entries)
{
  using dealii::ParameterHandler;
  ParameterHandler handler;
  for (const crawler::StoredEntry &entry : entries)
  {
    const std::size_t depth = entry.path.size() - 1;
    for (std::size_t i = 0; i < depth; ++i)
      handler.enter_subsection(entry.path[i]);
    handler.declare_entry(
      entry.path.back(), entry.info.default_value, crawler::WordyPattern(entry.info), entry.explanation);
    handler.add_action(entry.path.back(), [](const std::string &) {}); // an attribute says that there is one
    handler.set(entry.path.back(), entry.value);
    for (std::size_t i = 0; i < depth; ++i)
      handler.leave_subsection();
  }
  handler.print_parameters(out, ParameterHandler::XML | ParameterHandler::KeepDeclarationOrder);
}
