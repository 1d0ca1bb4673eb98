// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace crawler::test
{
  /// What an action says of bad input, behind the name of the entry, if there is one; "nothing" if it is taken.
  template <typename Action>
  std::string
  complaint_of(const Action &action)
  {
    try
    {
      action();
    }
    catch (const InputError &error)
    {
      return (error.entry.empty() ? "" : error.entry + ": ") + error.what();
    }
    return "nothing";
  }

  inline void
  expect_words(const std::string &found, const std::vector<std::string> &words)
  {
    for (const std::string &word : words)
      EXPECT_NE(found.find(word), std::string::npos) << "\"" << word << "\" is not in \"" << found << "\"";
  }
} // namespace crawler::test
