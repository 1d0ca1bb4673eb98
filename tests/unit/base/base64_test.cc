// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/base64.h>
#include <crawler/base/exceptions.h>

#include <gtest/gtest.h>

using namespace crawler;

/// The examples of RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard)
{
  const std::pair<const char *, const char *> examples[] = {{"", ""},
                                                            {"f", "Zg=="},
                                                            {"fo", "Zm8="},
                                                            {"foo", "Zm9v"},
                                                            {"foob", "Zm9vYg=="},
                                                            {"fooba", "Zm9vYmE="},
                                                            {"foobar", "Zm9vYmFy"}};
  for (const auto &[text, code] : examples)
  {
    const std::string words = text;
    const std::vector<unsigned char> bytes(words.begin(), words.end());
    EXPECT_EQ(encode_base64(bytes), code);
    EXPECT_EQ(decode_base64(code), bytes);
  }
}

TEST(Base64, AllBytesComeBack)
{
  std::vector<unsigned char> bytes;
  for (unsigned int i = 0; i < 1000; ++i)
  {
    bytes.push_back(static_cast<unsigned char>(i * i % 256));
    EXPECT_EQ(decode_base64(encode_base64(bytes)), bytes);
  }
}

TEST(Base64, RefusesOtherTexts)
{
  for (const char *text : {"Z", "Zg=", "Zm9v!A==", "Zm 9", "Zm9vYmF"})
    EXPECT_THROW(decode_base64(text), InputError) << text;
}
