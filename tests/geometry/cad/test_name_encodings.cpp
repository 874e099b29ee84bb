// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/utf8.h"
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

/// A STEP file whose first faces are called so, in bytes.
SurfaceModel model_with(const std::string& bytes, const std::string& second = "") {
  std::ostringstream out;
  write_example("thin_box", CadFormat::kStep, out);
  std::string text = out.str();
  const std::string empty = "ADVANCED_FACE(''";
  std::size_t at = 0;
  for (const std::string& name : {bytes, second}) {
    at = text.find(empty, at);
    text.insert(at + empty.size() - 1, name);
    at += empty.size();
  }
  return read_cad(CadModel{{}, text});
}

/// The names of its faces.
std::vector<std::string> names_with(const std::string& bytes, const std::string& second = "") {
  std::vector<std::string> names;
  for (const Entity& face : model_with(bytes, second).fine.regions)
    names.insert(names.end(), face.names.begin(), face.names.end());
  return names;
}

bool has_name(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

TEST(NameEncodings, EscapesOfTheStandard) {
  EXPECT_TRUE(has_name(names_with("\\X2\\8F935165\\X0\\1"), "\u8F93\u51651"));
  EXPECT_TRUE(has_name(names_with("Gr\\X2\\00F600DF\\X0\\e"), "Gr\u00F6\u00DFe"));
  EXPECT_TRUE(has_name(names_with("\\X\\C4nderung"), "\u00C4nderung"));
}

TEST(NameEncodings, BytesOfOtherSystems) {
  EXPECT_TRUE(has_name(names_with("Gr\xC3\xB6\xC3\x9F"
                                  "e"),
                       "Gr\u00F6\u00DFe"));  // UTF-8
  EXPECT_TRUE(has_name(names_with("\xCA\xE4\xC8\xEB"
                                  "1"),
                       "\u8F93\u5165"
                       "1"));                                                                     // GB 2312
  EXPECT_TRUE(has_name(names_with("\x83{\x83X-\x89\x9F\x82\xB5"), "\u30DC\u30B9-\u62BC\u3057"));  // Shift-JIS
  EXPECT_TRUE(has_name(names_with("Gr\xF6\xDF"
                                  "e"),
                       "Gr\u00F6\u00DFe"));  // ISO 8859-1
  EXPECT_TRUE(has_name(names_with("M\xE9tal", "\xC4\xD6"), "\u00C4\u00D6"))
      << "all names of a file are in one";
}

TEST(NameEncodings, WhatIsGuessedIsTold) {
  const auto tells = [](const std::string& bytes, const std::string& text) {
    return is_reported(model_with(bytes).warnings, text);
  };
  EXPECT_TRUE(tells("\xD6\xC4", "were taken for GB 2312 or GBK, as '\u5E1C'"));
  EXPECT_TRUE(tells("M\xE9tal", "were taken for ISO 8859-1, as 'M\u00E9tal'"));
  for (const char* text : {"M\u00E9tal", "\\X\\C4nderung", "plain"})
    EXPECT_FALSE(tells(text, "taken for")) << text;
}

TEST(NameEncodings, AreAlwaysUtf8) {
  for (const int byte : {0x80, 0x95, 0xC3, 0xE9, 0xFF})
    for (const std::string& name :
         names_with(std::string("a") + static_cast<char>(byte) + " " + static_cast<char>(byte)))
      EXPECT_TRUE(is_utf8(name)) << byte;
}

TEST(NameEncodings, Utf8IsToldByItsBytes) {
  for (const char* text : {"", "plain", "\u00E9", "\u4EFB\u4F55", "\U0001F600"})
    EXPECT_TRUE(is_utf8(text)) << text;
  for (const char* text :
       {"\xE9", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xC3", "\x80"})
    EXPECT_FALSE(is_utf8(text)) << as_utf8(text);
  EXPECT_EQ(as_utf8("\xE9t\xE9"), "\u00E9t\u00E9");
}

}  // namespace
}  // namespace delquad
