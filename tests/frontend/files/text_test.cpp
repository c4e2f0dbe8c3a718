#include "frontend/files/load_file.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/files/other_formats.hpp"
#include "frontend/files/text.hpp"
#include "frontend/input/read_scene.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/gzip.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::message_of;
using test::TemporaryFolder;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float number(std::string_view word) {
  float value = -77;
  EXPECT_TRUE(to_number(word, value)) << word;
  return value;
}

TEST(Number, ReadsWhatFilesHold) {
  EXPECT_EQ(number("1.11022e-16"), 1.11022e-16f);
  EXPECT_EQ(number("-.5"), -0.5f);
  EXPECT_EQ(number("+3"), 3.0f);
  EXPECT_EQ(number("1e5"), 1e5f);
  EXPECT_EQ(number("000"), 0.0f);
  EXPECT_EQ(number("5."), 5.0f);
  EXPECT_TRUE(std::signbit(number("-0")));
  EXPECT_EQ(number("+inf"), kInfinity);
  EXPECT_EQ(number("-inf"), -kInfinity);
  EXPECT_TRUE(std::isnan(number("nan")));
}

TEST(Number, ReadsWhatMicrosoftWrote) {
  for (const char* word : {"1.#INF", "+1.#INF", "1.#INF00", "1.#INF00e+000"})
    EXPECT_EQ(number(word), kInfinity) << word;
  EXPECT_EQ(number("-1.#INF"), -kInfinity);
  for (const char* word : {"1.#IND",
                           "-1.#IND",
                           "-1.#IND00",
                           "1.#QNAN",
                           "1.#QNAN0e+000",
                           "1.#SNAN",
                           "1.#J",
                           "-1.#IO",
                           "-nan(ind)",
                           "nan(snan)"})
    EXPECT_TRUE(std::isnan(number(word))) << word;
  float value;
  double of_double;
  EXPECT_TRUE(to_number("-1.#INF", of_double) && of_double < 0 && std::isinf(of_double));
  for (const char* word : {"1.#", "2.#INF", "1.#INFO", "1.#X", "1#INF", "1.#INF 0", "#INF"})
    EXPECT_FALSE(to_number(word, value)) << word;
}

TEST(Number, TooLargeIsInfiniteTooSmallIsZero) {
  EXPECT_EQ(number("1e39"), kInfinity);
  EXPECT_EQ(number("-1e39"), -kInfinity);
  EXPECT_EQ(number("1e-60"), 0.0f);
  EXPECT_EQ(number("1e99999999999999999999"), kInfinity);
  EXPECT_EQ(number("1e-99999999999999999999"), 0.0f);
  EXPECT_EQ(number("0.0000000000000000000000000000000000000000000000000000000000001"), 0.0f);
  EXPECT_EQ(number(std::string(60, '9')), kInfinity);
  EXPECT_EQ(number("+1e+400"), kInfinity);
}

TEST(Number, RefusesTheRest) {
  float value;
  for (const char* word : {"",
                           "x",
                           "1.5.2",
                           "0.0780.3610.753",
                           "1e",
                           "--1",
                           "+-1",
                           "+",
                           "-",
                           ".",
                           "0x10",
                           "1,5",
                           "1f"})
    EXPECT_FALSE(to_number(word, value)) << word;
}

TEST(Integer, ReadsWholeNumbersOnly) {
  std::int64_t value;
  EXPECT_TRUE(to_integer("512", value) && value == 512);
  EXPECT_TRUE(to_integer("+4", value) && value == 4);
  EXPECT_TRUE(to_integer("3.0", value) && value == 3);
  EXPECT_TRUE(to_integer("-1", value) && value == -1);
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  EXPECT_TRUE(to_integer("1e300", value) && value == kLargest);
  EXPECT_TRUE(to_integer("99999999999999999999", value) && value == kLargest);
  EXPECT_TRUE(to_integer("-1e300", value) && value == -kLargest);
  for (const char* word : {"", "3.5", "inf", "1e400", "nan", "3x"})
    EXPECT_FALSE(to_integer(word, value)) << word;
}

TEST(Integer, LooksLikeANumber) {
  for (const char* word : {"1", "-.5", "+3", ".5x", "1.5.2", "nan", "-inf"})
    EXPECT_TRUE(looks_like_number(word)) << word;
  for (const char* word : {"", "s", "-", "+x", ".", "/1", "infinite"})
    EXPECT_FALSE(looks_like_number(word)) << word;
}

TEST(Words, SplitAtBlanksAndComments) {
  Words words("f", "  a\tb#c d\r\n# e\rf\n\n\fg", 0, Comments::kAll);
  for (const char* expected : {"a", "b", "f", "g", "", ""})
    EXPECT_EQ(words.next(), expected);
}

TEST(Words, StepOverCommentsOfC) {
  const std::string_view text = "a//b\nc/*d*/e /*f\n*/ /*/g*/ 1.#h\ni/j 1.#INF / * /*k";
  Words all("f", text, 0, Comments::kAll);
  for (const char* expected : {"a", "c", "e", "1.", "i/j", "1.#INF", "/", "*", "/*k", ""})
    EXPECT_EQ(all.next(), expected);
  Words none("f", "a //b # /*c*/", 0, Comments::kNone);
  for (const char* expected : {"a", "//b", "#", "/*c*/", ""})
    EXPECT_EQ(none.next(), expected);
}

TEST(Words, ACommentOfManyLinesEndsTheLine) {
  Words words("f", "a /* 1 */ b /* 2\n3 */ c d /* 4\n5 */ e\nf", 0, Comments::kAll);
  words.next();
  EXPECT_EQ(words.peek_on_line(), "b");
  words.next();
  EXPECT_EQ(words.peek_on_line(), "");
  words.next();
  EXPECT_TRUE(words.at_line_start());
  words.skip_line();
  EXPECT_EQ(words.next(), "f") << "e stands on the line on which the comment began";
}

TEST(Words, NamesMayHoldWhatCommentsBeginWith) {
  for (const auto& [line, name] : {std::pair(" a//b/*c.ply // d", "a//b/*c.ply"),
                                   std::pair(" 'a #b' /* d */", "'a #b'"),
                                   std::pair("\"a // b\"# d", "\"a // b\""),
                                   std::pair("\"a # b", "\"a"),
                                   std::pair("  # d", ""),
                                   std::pair("", "")}) {
    const std::string text = std::string(line) + "\nnext";
    Words words("f", text, 0, Comments::kAll);
    EXPECT_EQ(words.tail_of_line(), name) << line;
    EXPECT_EQ(words.next(), "next") << line;
  }
}

TEST(Words, KnowWhereTheLineEnds) {
  Words words("f", "a b # c\n\nd", 0, Comments::kAll);
  words.next();
  EXPECT_TRUE(words.at_line_start());
  EXPECT_EQ(words.peek_on_line(), "b");
  words.next();
  EXPECT_FALSE(words.at_line_start());
  EXPECT_EQ(words.peek_on_line(), "");
  EXPECT_EQ(words.peek(), "d");
  words.next();
  EXPECT_TRUE(words.at_line_start());
}

TEST(Words, SkipLinesAndTakeTheirRest) {
  Words words("f", "a  b c  # d\re f\r\ng", 0, Comments::kAll);
  words.next();
  EXPECT_EQ(words.tail_of_line(), "b c");
  EXPECT_EQ(words.next(), "e");
  words.skip_line();
  EXPECT_EQ(words.next(), "g");
  EXPECT_TRUE(words.at_line_start());
}

TEST(Words, CountLinesByAnyEnd) {
  Words words("f", "a\nb\r\nc\rd\n\re", 0, Comments::kAll);
  const char* const expected[] = {"f:1:1", "f:2:1", "f:3:1", "f:4:1", "f:6:1", "f:6:2"};
  std::vector<std::string_view> found;
  for (const char* location : expected) {
    found.push_back(words.next());
    EXPECT_EQ(words.position(found.back()).text(), location);
  }
  EXPECT_EQ(words.position(found[1]).text(), "f:2:1");  // also backwards
}

TEST(Words, QuotedStayOnOneLine) {
  EXPECT_EQ(grelha::quoted(std::string_view("a\x01\xff", 3)), "\"a??\"");
  EXPECT_EQ(grelha::quoted(std::string(50, 'x')), '"' + std::string(40, 'x') + "...\"");
  EXPECT_EQ(grelha::quoted(""), "end of file");
}

TEST(Gzip, InflatesMembersOneAfterTheOther) {
  const std::string long_text(1000000, 'a');
  EXPECT_EQ(inflate_gzip("f.gz", test::gzip(long_text), 1 << 20), long_text);
  EXPECT_EQ(inflate_gzip("f.gz", test::gzip("abc") + test::gzip("def"), 100), "abcdef");
  EXPECT_EQ(inflate_gzip("f.gz", test::gzip("abc") + "tail", 100), "abc");
  EXPECT_EQ(inflate_gzip("f.gz", test::gzip(""), 100), "");
  constexpr std::size_t kMiB = std::size_t(1) << 20;
  EXPECT_LE(inflate_limit(8 * kMiB), 768 * kMiB) << "a bomb of 8 MiB holds 8 GiB";
  EXPECT_GE(inflate_limit(0), std::min(256 * kMiB, std::size_t(system_memory() / 2)));
}

TEST(Gzip, RefusesBrokenAndBoundlessData) {
  const std::string whole = test::gzip("some words and some more words");
  EXPECT_EQ(message_of([&] { inflate_gzip("f.gz", whole.substr(0, 20), 100); }),
            "f.gz:byte 20: error: expected more gzip data, found end of file");
  std::string broken = whole;
  broken[12] = char(~broken[12]);
  EXPECT_NE(message_of([&] {
              inflate_gzip("f.gz", broken, 100);
            }).find(": error: expected sound gzip data, found "),
            std::string::npos);
  const std::string bomb = test::gzip(std::string(1 << 20, '\0'));
  EXPECT_NE(message_of([&] {
              inflate_gzip("f.gz", bomb, 5000);
            }).find("error: expected data that inflate to at most 5000 bytes, found more"),
            std::string::npos);
}

/// 256 MiB of zeros in 260 KB: the first piece tells, and no more is inflated.
TEST(Gzip, IsJudgedAsItComes) {
  const std::string bomb = test::gzip(std::string(std::size_t(256) << 20, '\0'));
  std::size_t largest = 0;
  const Validate validate = [&](std::string_view text, std::size_t fresh) {
    largest = std::max(largest, text.size());
    validate_start("f.gz", false, text, fresh);
  };
  EXPECT_EQ(
      message_of([&] { inflate_gzip("f.gz", bomb, std::size_t(1) << 30, nullptr, validate); }),
      "f.gz:byte 0: error: expected a scene's numbers, found 16777216 bytes without a digit");
  EXPECT_LT(largest, 2 * kPart);
  std::string late = "s 0 0 0 1\n";
  late.resize(3 * kPart, ' ');
  EXPECT_NE(message_of([&] {
              inflate_gzip("f.gz", test::gzip(late), std::size_t(1) << 30, nullptr, validate);
            }).find("without a digit"),
            std::string::npos);
  late.back() = '1';
  for (std::size_t i = 0; i < late.size(); i += kPart / 2)
    late[i] = '1';
  EXPECT_EQ(inflate_gzip("f.gz", test::gzip(late), std::size_t(1) << 30, nullptr, validate), late);
}

/// The same of files and whatever they inflate to, by the way of a scene.
TEST(LoadFile, JudgesScenesAsTheyCome) {
  const TemporaryFolder folder;
  const std::string zeros(2 * kPart, '\0');
  for (const char* name : {"zeros.nff", "zeros.ply"}) {
    const std::string path = folder.add(name, zeros),
                      packed = folder.add(std::string(name) + ".gz", test::gzip(zeros));
    for (const std::string& file : {path, packed})
      EXPECT_TRUE(
          message_of([&] {
            read_scene(file, nullptr);
          }).starts_with(file + ":byte 0: error: expected a scene's numbers, found 16777216 bytes"))
          << file;
  }
  const std::string other = folder.add("other.ply.gz", test::gzip(" plx " + zeros));
  EXPECT_EQ(message_of([&] { read_scene(other, nullptr); }),
            other + ":1:2: error: expected \"ply\" on the first line, found \"plx\"");
  const std::string scene = folder.add("scene.nff", test::kView + "ply other.ply.gz\n");
  EXPECT_EQ(message_of([&] { read_scene(scene, nullptr); }),
            other + ":1:2: error: expected \"ply\" on the first line, found \"plx\"");
}

TEST(LoadFile, TellsGzipByItsFirstBytes) {
  const TemporaryFolder folder;
  EXPECT_EQ(load_file(folder.add("a.nff", test::gzip("packed"))), "packed");
  EXPECT_EQ(load_file(folder.add("b.gz", "plain")), "plain");
}

TEST(LoadFile, SaysWhyItCannot) {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "none").string();
  EXPECT_EQ(message_of([&] { load_file(missing); }),
            missing + ": error: cannot open: No such file or directory");
  const std::string self = folder.path().string();
  EXPECT_EQ(message_of([&] { load_file(self); }), self + ": error: cannot read: Is a directory");
  EXPECT_THROW(load_file("/dev/null"), FileError);
}

TEST(Words, NextNumberLeavesWhatIsNone) {
  for (const std::string text :
       {"", " ", "x", "1x", "1.5.2", "--1", "-", "e5", "0x10", "#1", "1e400", "+1"}) {
    Words words("w", text, 0, Comments::kAll);
    float value;
    EXPECT_FALSE(words.next_number(value)) << text;
    EXPECT_EQ(words.cursor(), text.data()) << text;
  }
}

}  // namespace
}  // namespace grelha
