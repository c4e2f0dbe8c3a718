// Tests the text that is printed on a terminal.
#include "frontend/files/text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grelha {
namespace {

using std::string_literals::operator""s;

TEST(Shown, WordsOfAnyLanguageStay) {
  for (const char* text : {"",
                           "a b/c-d.nff",
                           "bal\xC3\xB5"
                           "es",
                           "\xE7\x90\x83.nff",
                           "\xF0\x9F\x8E\xB1"})
    EXPECT_EQ(printable_text(text), text);
  EXPECT_EQ(printable_text("a\nb\n"), "a\nb\n");
  EXPECT_EQ(printable_line("a\nb"), "a?b");
}

TEST(Shown, WhatATerminalObeysDoesNot) {
  const std::pair<std::string, const char*> table[] = {
      {"\x1b[2J\x1b]0;title\x07", "?[2J?]0;title?"},
      {"a\rb\tc\0d\x7f"s, "a?b?c?d?"},
      {"\xC2\x9B"
       "31m",
       "?31m"},  // the same as UTF-8
  };
  for (const auto& [text, clean] : table)
    EXPECT_EQ(printable_text(text), clean);
}

}  // namespace
}  // namespace grelha
