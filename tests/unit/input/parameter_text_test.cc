#include <impm/base/exceptions.h>
#include <impm/input/parameter_text.h>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "scene_fixture.h"

using namespace impm;

namespace
{
  namespace fs = std::filesystem;

  // Files in a folder that goes with its scope.
  struct Folder
  {
    Folder()
      : name(testing::TempDir() + "impm_text_" + std::to_string(getpid()))
    {
      fs::create_directories(name + "/inner");
    }

    ~Folder()
    {
      fs::remove_all(name);
    }

    std::string
    write(const std::string &file, const std::string &text) const
    {
      std::ofstream(name + "/" + file) << text;
      return name + "/" + file;
    }

    const std::string name;
  };

  void
  expect_refusal(const std::string &file, const std::vector<std::string> &words)
  {
    try
      {
        read_parameter_text(file);
        ADD_FAILURE() << file << " is taken";
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos);
        EXPECT_LT(message.size(), 5000u);
        for (const auto &word : words)
          EXPECT_NE(message.find(word), std::string::npos)
            << "found '" << message << "', expected '" << word << "'";
      }
  }
} // namespace


TEST(ParameterText, WhatMayStandInAFile)
{
  const Folder folder;
  folder.write("inner/last.prm", "set File = mesh.msh\n");
  folder.write("inner/more.prm", "\xEF\xBB\xBFset C = 3\r\ninclude last.prm\n");
  const auto file  = folder.write("main.prm",
                                 "\xEF\xBB\xBFsubsection\tA # first\r\n"
                                  "\tset\tB = 1, \\\n"
                                  "   2, \\\n"
                                  "   3 # all\n"
                                  "  include\tinner/more.prm\n"
                                  "END\n"
                                  "\n"
                                  "SET D = a = b # C:\\here\\\n"
                                  "set E =");
  const auto lines = read_parameter_text(file);
  ASSERT_EQ(lines.size(), 6u);
  using Path = std::vector<std::string>;
  EXPECT_TRUE(lines[0].is_subsection);
  EXPECT_EQ(lines[0].path, Path{"A"});
  EXPECT_EQ(lines[1].path, (Path{"A", "B"}));
  EXPECT_EQ(lines[1].value, "1, 2, 3");
  EXPECT_EQ(lines[1].place(), "file " + file + ", line 2");
  EXPECT_EQ(lines[2].path, (Path{"A", "C"}));
  EXPECT_EQ(lines[2].place(),
            "file " + folder.name + "/inner/more.prm, line 1");
  EXPECT_EQ(lines[3].value, folder.name + "/inner/mesh.msh");
  EXPECT_EQ(lines[4].path, Path{"D"});
  EXPECT_EQ(lines[4].value, "a = b");
  EXPECT_EQ(lines[4].number, 8u);
  EXPECT_EQ(lines[5].value, "");
}


TEST(ParameterText, WhatIsWrong)
{
  const Folder folder;
  const auto   expect = [&](const std::string              &text,
                          const std::vector<std::string> &words) {
    SCOPED_TRACE(text);
    expect_refusal(folder.write("bad.prm", text), words);
    // the same from another file
    folder.write("inner/bad.prm", text);
    auto all = words;
    all.push_back("inner/bad.prm, line");
    expect_refusal(folder.write("main.prm",
                                "subsection A\ninclude inner/bad.prm\nend\n"),
                   all);
  };
  expect("subsection A\n\tsubsection B\nset C = 1\nend\n",
         {"line 1", "no 'end' of the subsection 'A'"});
  expect("set A = 1\nend\n", {"line 2", "found 'end'"});
  expect("end # of what?\n", {"line 1", "found 'end'"});
  expect("subsection A\nend of A\n", {"line 2", "found 'end of A'", "allowed"});
  expect("set A\n", {"line 1", "found 'set A'", "set NAME = VALUE"});
  expect("subsection\n", {"line 1", "found 'subsection'"});
  expect("\nA = 1\n", {"line 2", "found 'A = 1'"});
  expect("Set A = 1\n", {"found 'Set A = 1'"});
  expect("set A = 1 \\\n", {"line 1", "at the end"});
  expect(std::string("set A = \0", 9), {"line 1", "0x00", "UTF-8"});
  expect("\x89PNG\r\n\x1A\n", {"line 1", "UTF-8"});
  expect("set A = 1\nset B = caf\xE9\n", {"line 2", "UTF-8"});
  expect(std::string("\xFF\xFEs\0e\0t\0", 8), {"line 1", "UTF-16"});
  expect("set A = 1\rset B = 2\r", {"line 1", "carriage return"});
  expect("set A = 1e-320\n", {"line 1", "'1e-320'", "allowed"});
  std::string deep;
  for (unsigned int i = 0; i < 100000; ++i)
    deep += "subsection A\n";
  expect(deep, {"more than 1000 sections"});
  expect("include nowhere.prm\n", {"line 1", "'nowhere.prm'", "no such file"});
  expect("include .\n", {"line 1", "a directory"});
  expect("include /dev/zero\n", {"line 1", "no regular file"});
  for (const std::string name : {"/dev/zero", "/dev/null"})
    expect_refusal(name, {"cannot read", name, "no regular file"});
  const std::string pipe = folder.name + "/pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_refusal(pipe, {"no regular file"});
}


TEST(ParameterText, FilesThatIncludeEachOther)
{
  const Folder folder;
  const auto   one = folder.write("one.prm", "include inner/two.prm\n");
  folder.write("inner/two.prm", "\ninclude ../link.prm\n");
  fs::create_symlink(one, folder.name + "/link.prm");
  expect_refusal(one,
                 {"inner/two.prm, line 2",
                  "one.prm includes " + folder.name +
                    "/inner/two.prm includes " + folder.name +
                    "/inner/../link.prm"});
  // Nobody goes round here.
  folder.write("link.prm", "set A = 1\n");
  const auto twice =
    folder.write("twice.prm", "include a.prm\ninclude a.prm\n");
  folder.write("a.prm", "set B = 1\n");
  EXPECT_EQ(read_parameter_text(twice).size(), 2u);
  for (unsigned int i = 0; i < 1000; ++i)
    folder.write(std::to_string(i) + ".prm",
                 "include " + std::to_string(i + 1) + ".prm\n");
  folder.write("1000.prm", "set A = 1\n");
  EXPECT_EQ(read_parameter_text(folder.name + "/0.prm").size(), 1u);
  for (unsigned int i = 1000; i < 1005; ++i)
    folder.write(std::to_string(i) + ".prm",
                 "include " + std::to_string(i + 1) + ".prm\n");
  expect_refusal(folder.name + "/0.prm",
                 {"1000.prm, line 1", "at most 1000 files"});
  // Each of these twice the next one.
  for (unsigned int i = 0; i < 60; ++i)
    {
      const auto next = "include " + std::to_string(i + 1) + ".prm\n";
      folder.write(std::to_string(i) + ".prm", next + next);
    }
  folder.write("60.prm", std::string(20'000'000, ' ') + "\n");
  expect_refusal(folder.name + "/0.prm", {"60.prm", "100 MB"});
}


TEST(ParameterText, Overrides)
{
  const Folder folder;
  const auto   file = folder.write("main.prm", "set A = 1\n");
  folder.write("inner/mesh.msh", "");
  const auto value = [&](const std::string &override) {
    return parameter_override(override, file).value;
  };
  EXPECT_EQ(value("A/B= x=1; \"y\" "), "x=1; \"y\"");
  EXPECT_EQ(value("A="), "");
  EXPECT_EQ(value("A/File=inner/mesh.msh"), folder.name + "/inner/mesh.msh");
  EXPECT_EQ(value("A/File=CMakeCache.txt"),
            fs::current_path().string() + "/CMakeCache.txt");
  EXPECT_EQ(parameter_override("A/B=1", file).place(), "--set A/B=1");
  for (const std::string wrong : {"",
                                  "A",
                                  "=1",
                                  "A=1\nset B = 2",
                                  "A=1 # not more",
                                  "A=1\\",
                                  "A=caf\xE9",
                                  "A=1e-320"})
    EXPECT_THROW(value(wrong), InputError) << wrong;
}
