// SPDX-License-Identifier: LGPL-2.1-or-later
// A table into which all ranks write; run on several, too.
#include "../../support/test.h"

#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/row_file.h>

namespace
{
  using namespace crawler;

  Table
  read_table(const std::filesystem::path &path, const std::string &group)
  {
    const RowReader reader(MPI_COMM_SELF, path, group);
    return reader.read(0, reader.n_rows());
  }

  const std::vector<RowFile::Column> columns = {
    {"index", "1", "number", 0}, {"A/x", "length", "a number", 0}, {"word", "", "a text of at most 6 bytes", 6}};

  std::filesystem::path
  a_file()
  {
    return std::filesystem::temp_directory_path() /
           ("row_file_test_" + broadcast(std::to_string(::getpid()), MPI_COMM_WORLD));
  }

  TEST(RowFile, KeepsRowsOfAllRanksAndLeavesOthersEmpty)
  {
    const auto path            = a_file();
    const unsigned int n_ranks = size_of(MPI_COMM_WORLD), rank = rank_of(MPI_COMM_WORLD);
    const unsigned long n = 4ul * n_ranks;
    on_first_rank(MPI_COMM_WORLD, [&]() { RowFile::create(path, "results", columns, n, {{"made by", "a test"}}); });
    {
      RowFile file(MPI_COMM_WORLD, path, "results", columns);
      const std::vector<RowFile::Row> rows = {{4. * rank, 0.5 * rank, "first"},
                                              {4. * rank + 1.,
                                               1e300,
                                               "gr\xc3\xbc\xc3\x9f"
                                               "e!"}};
      file.write(4ul * rank, rows);
      file.write(4ul * rank + 3, std::vector<RowFile::Row>{{4. * rank + 3., -0., ""}});
    }
    if (rank > 0)
      return;
    const Table table = read_table(path, "results");
    ASSERT_EQ(table.size(), 3u);
    EXPECT_EQ(table[1].name, "A/x");
    EXPECT_EQ(table[1].unit, "length");
    EXPECT_EQ(read_attribute(path, "results", "made by"), "a test");
    const auto &index = std::get<std::vector<double>>(table[0].values),
               &x     = std::get<std::vector<double>>(table[1].values);
    const auto &word  = std::get<std::vector<std::string>>(table[2].values);
    ASSERT_EQ(index.size(), n);
    for (unsigned int r = 0; r < n_ranks; ++r)
    {
      EXPECT_EQ(index[4 * r + 1], 4. * r + 1.);
      EXPECT_EQ(x[4 * r], 0.5 * r);
      EXPECT_EQ(x[4 * r + 1], 1e300);
      EXPECT_EQ(word[4 * r], "first");
      EXPECT_EQ(word[4 * r + 1], "gr\xc3\xbc\xc3\x9f"); // cut, but not within a character
      EXPECT_TRUE(std::isnan(index[4 * r + 2]) && std::isnan(x[4 * r + 2]) && word[4 * r + 2].empty());
    }
    {
      const RowReader reader(MPI_COMM_SELF, path, "results");
      EXPECT_EQ(reader.n_rows(), n);
      EXPECT_THROW(reader.index_of("nothing"), FileError);
      const auto words = std::get<std::vector<std::string>>(reader.read(reader.index_of("word"), 1, 3).values);
      EXPECT_EQ(words, std::vector<std::string>(word.begin() + 1, word.begin() + 4));
      EXPECT_EQ(csv_names(table) + csv_rows(reader.read(0, 2)) + csv_rows(reader.read(2, n - 2)), csv(table));
    }
    std::filesystem::remove(path);
  }

  TEST(RowFile, ColumnsThatAreKnownAreThereFromTheBeginning)
  {
    const auto path = a_file();
    if (rank_of(MPI_COMM_WORLD) > 0)
      return;
    const unsigned long n = 100000; // more than are written at once
    const std::string large(100000, 'x');
    RowFile::create(path,
                    "results",
                    {columns[0], columns[2], columns[1]},
                    n,
                    {{"large", large}},
                    {2, [](const std::size_t column, const unsigned long row) -> RowFile::Value {
                       if (column == 0)
                         return static_cast<double>(row);
                       return std::to_string(row);
                     }});
    {
      RowFile file(MPI_COMM_SELF, path, "results", {columns[1]}); // the others stay as they are
      file.write(n - 1, std::vector<RowFile::Row>{{2.5}});
    }
    EXPECT_EQ(read_attribute(path, "results", "large"), large);
    const Table table = read_table(path, "results");
    const auto &x     = std::get<std::vector<double>>(table[2].values);
    for (unsigned long i = 0; i < n; ++i)
    {
      ASSERT_EQ(std::get<std::vector<double>>(table[0].values)[i], static_cast<double>(i));
      ASSERT_EQ(std::get<std::vector<std::string>>(table[1].values)[i], std::to_string(i));
      ASSERT_TRUE(i + 1 == n ? x[i] == 2.5 : std::isnan(x[i]));
    }
    std::filesystem::remove(path);
  }

  TEST(RowFile, AFileThatIsNoneIsAFileError)
  {
    EXPECT_THROW(read_table("/nowhere/at/all.h5", "results"), FileError);
    EXPECT_THROW(RowFile::create("/nowhere/at/all.h5", "results", columns, 3, {}), FileError);
  }
} // namespace
