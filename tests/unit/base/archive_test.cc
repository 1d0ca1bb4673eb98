// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/archive.h>
#include <crawler/base/exceptions.h>

#include <deque>

namespace
{
  enum class Colour
  {
    red,
    green
  };
} // namespace

template <>
inline constexpr const char *crawler::words_of<Colour>[] = {"red", "green"};

namespace
{
  using namespace crawler;

  struct Inner
  {
    std::vector<double> values;
    std::string text;

    void
    exchange(Archive &archive)
    {
      archive(values, text);
    }
    bool
    operator==(const Inner &) const = default;
  };

  struct Outer
  {
    double number = 0.;
    std::deque<Inner> list;
    std::array<Inner, 2> two;
    std::optional<Inner> one, none;
    std::pair<double, double> pair;

    void
    exchange(Archive &archive)
    {
      archive(number, list, two, one, none, pair);
    }
    bool
    operator==(const Outer &) const = default;
  };

  struct Progress
  {
    double t                   = 0.;
    bool is_retry              = false;
    Colour colour              = Colour::red;
    std::optional<double> size = 1.;

    void
    exchange(auto &archive)
    {
      archive(t, is_retry, colour, size);
    }
  };

  Outer
  an_outer()
  {
    return {0.1,
            {{{1. / 3., -0., 5e-324}, "a"}, {{}, ""}},
            {{{{std::numeric_limits<double>::infinity()}, "b"}, {{2.}, std::string("\0\n", 2)}}},
            Inner{{4.}, "c"},
            std::nullopt,
            {1., 2.}};
  }

  TEST(Archive, GivesBackWhatWasWritten)
  {
    Outer written = an_outer(), read;
    read.none     = Inner{{1.}, "to be forgotten"};
    Archive archive(archived(written));
    archive(read);
    EXPECT_EQ(read, written);
    EXPECT_TRUE(std::signbit(read.list[0].values[1]));
    EXPECT_EQ(archived(read), archived(written));
  }

  TEST(Archive, RefusesWhatIsCut)
  {
    Outer written           = an_outer();
    const std::string bytes = archived(written);
    for (std::size_t n = 0; n < bytes.size(); ++n)
    {
      Outer read;
      Archive archive(bytes.substr(0, n));
      EXPECT_THROW(archive(read), FileError) << n;
    }
  }

  TEST(Archive, AsksForNoMemoryThatIsNotThere)
  {
    std::size_t huge = std::numeric_limits<std::size_t>::max() / 16;
    std::vector<double> numbers;
    std::vector<Inner> objects;
    std::string text;
    Archive a(archived(huge)), b(archived(huge)), c(archived(huge));
    EXPECT_THROW(a(numbers), FileError);
    EXPECT_THROW(b(objects), FileError);
    EXPECT_THROW(c(text), FileError);
  }

  TEST(Archive, RefusesWhatIsNotTheSame)
  {
    unsigned int three = 3;
    Archive archive(archived(three));
    EXPECT_THROW(archive.require_same(4u, "the number"), FileError);
  }

  /// What an object without constructors would take from its bytes, and then use.
  TEST(Archive, RefusesValuesThatDoNotExist)
  {
    std::vector<Progress> list(1);
    const std::string bytes = archived(list);
    const std::size_t first = sizeof(std::size_t) + sizeof(double); // behind the size of the list and t
    for (const std::size_t place : {first, first + 1, first + 1 + sizeof(unsigned int)})
    {
      std::string damaged = bytes;
      damaged[place]      = '\xf0';
      Archive archive(damaged), whole(bytes);
      EXPECT_NO_THROW(whole(list));
      EXPECT_THROW(archive(list), FileError) << place;
    }
  }
} // namespace
