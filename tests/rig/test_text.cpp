// Text that is fit to be shown, and what becomes of text that is not.
#include "rig/text.h"

#include <gtest/gtest.h>
#include <random>

using namespace tutu;

namespace {

/// A code point in the bytes that UTF-8 has for it [RFC 3629, 3], or in more of them.
std::string bytes_of(unsigned code, int size) {
  if (size == 1) return std::string(1, static_cast<char>(code));
  std::string bytes(1, static_cast<char>((0xf00u >> size & 0xff) | code >> (6 * (size - 1))));
  for (int i = size - 2; i >= 0; --i) bytes += static_cast<char>(0x80 | (code >> (6 * i) & 0x3f));
  return bytes;
}
int size_of(unsigned code) { return code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4; }

TEST(Text, EveryCharacterIsPlainButControlsAndSurrogates) {
  for (unsigned code = 0; code <= 0x10ffff; ++code) {
    const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0), surrogate = code >= 0xd800 && code < 0xe000;
    const std::string text = "a" + bytes_of(code, size_of(code)) + "z";
    ASSERT_EQ(is_plain_text(text), !control && !surrogate) << code;
    ASSERT_EQ(plain_text(text), surrogate ? "a___z" : control ? "a_z" : text) << code;
  }
}

TEST(Text, NothingBeyondTheLastCharacterOrWrittenLongerThanNeeded) {
  for (const unsigned code : {0x110000u, 0x13ffffu, 0x1fffffu}) EXPECT_EQ(plain_text(bytes_of(code, 4)), "____");
  for (const unsigned code : {0x2fu, 0x41u, 0x7ffu, 0xffffu})
    for (int size = size_of(code) + 1; size <= 4; ++size)
      EXPECT_EQ(plain_text(bytes_of(code, size)), std::string(static_cast<std::size_t>(size), '_')) << code;
}

TEST(Text, BytesThatAreNoCharacter) {
  EXPECT_EQ(plain_text("caf\xe9"), "caf_"); // Latin-1
  EXPECT_EQ(plain_text("\xe2\x82"), "__");  // the euro sign cut off
  EXPECT_EQ(plain_text("\xe2\x82z"), "__z");
  EXPECT_EQ(plain_text("\x80\xff"), "__");
  EXPECT_EQ(plain_text("a\nb\tc", '?'), "a?b?c");
  EXPECT_EQ(plain_text(std::string_view("\0x", 2)), "_x");
  EXPECT_EQ(plain_text(""), "");
  EXPECT_TRUE(is_plain_text(""));
  EXPECT_TRUE(is_plain_text("Ärmel, 袖, \U0001F483"));
}

TEST(Text, WhatWasMadePlainIsPlain) {
  std::mt19937 random(3);
  int plain = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text(random() % 4, '\0');
    for (char& c : text) c = static_cast<char>(random() % 4 ? 0xc0 + random() % 64 - random() % 160 : random());
    plain += is_plain_text(text);
    ASSERT_TRUE(is_plain_text(plain_text(text)));
    ASSERT_EQ(plain_text(text) == text, is_plain_text(text));
  }
  EXPECT_GT(plain, 6'000);
  EXPECT_LT(plain, 14'000);
}

} // namespace
