// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <filesystem>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace crawler
{
  class Declarations;

  /// A line "set Entry = value" of a file or one --set of the command line, with its place.
  struct Assignment
  {
    std::string path;             ///< "Section/Entry", as normal_path() writes it
    std::string value;            ///< without blanks around it and without the comment
    std::string place;            ///< for messages: "fig_2.prm, line 12" or "--set ..."
    bool is_override;             ///< given by --set, which overrides all files
    std::filesystem::path folder; ///< to which a file name in the value is relative
    unsigned int depth = 0;       ///< nesting depth of the file: 0, or more if included
  };

  /**
   * A parameter file in deal.II's .prm format (subsection ... end, set name = value, # comments, \ at a line's end
   * continues it, include FILE) and its overrides. Settings below an include replace those of the included file. All
   * input is read here, so that every error names its file and line.
   */
  class ParameterFile
  {
  public:
    /// Reads a file; "-" is standard input. Throws FileError if it cannot be read and InputError with
    /// file and line if it is not a parameter file.
    static ParameterFile
    read(const std::string &file_name);

    /// Reads a text; @p name stands for the file's name in messages.
    static ParameterFile
    from_text(const std::string &text, const std::string &name);

    /// Adds an override "Section/Entry=value", which replaces the value of the file and of earlier overrides.
    void
    add_override(const std::string &assignment);

    /// Sets all entries; throws InputError with the place in the message.
    void
    apply(Declarations &declarations) const;

    /// The error with the place of the entry that it names in front, if the entry was set at all. A foreign sign there
    /// (slips.h) is named instead.
    InputError
    with_place(const InputError &error) const;

    /// Returns the result of @p work; an InputError that it throws gets its place.
    template <typename Work>
    auto
    placing_errors(const Work &work) const
    {
      try
      {
        return work();
      }
      catch (const InputError &error)
      {
        throw with_place(error);
      }
    }

    /// The sections within the section @p path that the file opens or sets entries of, sorted.
    std::set<std::string>
    subsections(const std::string &path) const;

    /// The assignment of an entry that counts, the last one; null if it is not set.
    const Assignment *
    assignment_of(const std::string &path) const;

    /// All assignments, in the order of file and command line.
    const std::vector<Assignment> &
    assignments() const
    {
      return assignments_;
    }
    const std::string &
    name() const
    {
      return name_;
    }
    const std::string &
    text() const
    {
      return text_;
    }
    const std::vector<std::string> &
    overrides() const
    {
      return overrides_;
    }

  private:
    void
    parse(const std::string &text, const std::string &name, unsigned int depth);
    void
    include(const std::string &file_name,
            const std::filesystem::path &folder,
            const std::string &place,
            unsigned int depth);

    void
    add(const Assignment &assignment);

    std::string name_;
    std::string text_;
    std::vector<std::string> overrides_;

    struct Section
    {
      std::string path, place;
    };
    std::vector<Assignment> assignments_;
    std::unordered_map<std::string, std::size_t> latest_; ///< assignment of each path
    unsigned int n_included_ = 0;
    std::size_t n_bytes_     = 0; ///< of all files
    std::vector<Section> sections_;
  };
} // namespace crawler
