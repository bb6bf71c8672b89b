// What every verb shares: help, mistyped words, exit codes, streams.
#include <algorithm>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class Frame : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};
};

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

void expect_one_screen(const std::string& page, const std::string& name) {
  const std::vector<std::string> lines = lines_of(page);
  EXPECT_LE(lines.size(), 24u) << name << "\n" << page;
  for (const std::string& line : lines)
    EXPECT_LE(line.size(), 100u) << name << ": " << line;
}

std::vector<std::string> all_verbs(const Program& limn) {
  std::vector<std::string> names;
  for (const auto& verb : limn.json({"help"})["verbs"])
    names.push_back(verb["name"]);
  return names;
}

TEST_F(Frame, ListsTheVerbsThatExistAndNoOthers) {
  const std::string page = limn.run({"--help"}).out;
  for (const char* verb : {"demo", "info", "make", "refine", "hull", "compare", "help", "version"}) {
    EXPECT_NE(page.find("\n  " + std::string(verb) + " "), std::string::npos) << verb;
  }
  for (const char* verb : {"fit", "bake", "clip", "view", "bench"}) {
    EXPECT_EQ(page.find("\n  " + std::string(verb) + " "), std::string::npos) << verb;
    EXPECT_EQ(limn.run({verb}).exit, 2) << verb;
  }
}

TEST_F(Frame, FitsEveryHelpOnOneScreen) {
  expect_one_screen(limn.run({"--help"}).out, "limn");
  for (const std::string& verb : all_verbs(limn)) {
    const Outcome outcome = limn.run({verb, "--help"});
    EXPECT_EQ(outcome.exit, 0);
    EXPECT_NE(outcome.out.find("usage: limn " + verb), std::string::npos);
    expect_one_screen(outcome.out, verb);
    EXPECT_EQ(limn.run({verb, "-h"}).out, outcome.out);
  }
}

TEST_F(Frame, NamesEveryFlagOnTheHelpScreen) {
  for (const auto& verb : limn.json({"help"})["verbs"]) {
    const std::string page = limn.run({verb["name"], "--help"}).out;
    for (const auto& option : verb["options"]) {
      EXPECT_NE(page.find(option["name"].get<std::string>()), std::string::npos) << verb["name"] << option["name"];
    }
  }
}

TEST_F(Frame, ShowsThreeExamplesAndEveryFlagInTheFullPage) {
  for (const auto& verb : limn.json({"help"})["verbs"]) {
    const std::string page = limn.run({"help", verb["name"]}).out;
    ASSERT_EQ(verb["examples"].size(), 3u);
    for (const auto& example : verb["examples"]) {
      EXPECT_NE(page.find(example["command"].get<std::string>()), std::string::npos) << example;
    }
    for (const auto& option : verb["options"]) {
      EXPECT_NE(page.find(option["what"].get<std::string>()), std::string::npos) << verb["name"] << option["name"];
    }
  }
}

TEST_F(Frame, AnswersAMistypedVerbWithTheNearest) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"rednre", "render"}, {"refien", "refine"}, {"inof", "info"},      {"comp", "compare"}, {"dmeo", "demo"},
      {"mkae", "make"},     {"hlep", "help"},     {"vesion", "version"}, {"Render", "render"}};
  for (const auto& [typed, meant] : cases) {
    const Outcome outcome = limn.run({typed});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("no such verb '" + typed + "'; did you mean '" + meant + "'?"), std::string::npos)
        << outcome.err;
  }
}

TEST_F(Frame, NamesTheNearestVerbEvenWhenItIsFar) {
  const Outcome outcome = limn.run({"triangulate"});
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("no such verb 'triangulate'; the nearest is '"), std::string::npos) << outcome.err;
}

TEST_F(Frame, AnswersAMistypedFlagWithTheNearest) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"refine", "a.ply", "--max-levle", "3"}, "--max-level"},
      {{"refine", "a.ply", "--blnd=paper"}, "--blend"},
      {{"compare", "a.ply", "b.ply", "--veiws", "3"}, "--views"},
      {{"info", "--jsn"}, "--json"},
      {{"make", "--faes", "10"}, "--faces"},
      {{"demo", "--quite"}, "--quiet"}};
  for (const auto& [words, meant] : cases) {
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("no such flag '"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("did you mean '" + meant + "'?"), std::string::npos) << outcome.err;
  }
}

TEST_F(Frame, AnswersAMistypedChoiceWithTheNearest) {
  const Outcome outcome = limn.run({"refine", "a.ply", "-o", "b.ply", "--criterion", "silhuette"});
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("--criterion takes silhouette, distance"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("did you mean 'silhouette'?"), std::string::npos) << outcome.err;
  EXPECT_NE(limn.run({"make", "cubs", "-o", "a.ply"}).err.find("did you mean 'cube'?"), std::string::npos);
}

TEST_F(Frame, ExitsWith2OnEveryKindOfWrongUsage) {
  const std::vector<Arguments> cases = {
      {},
      {"--colour"},
      {"nothing"},
      {"info"},
      {"info", "a.ply", "b.ply"},
      {"info", "a.ply", "-o", "b.ply"},
      {"info", "--input-format"},
      {"info", "a.ply", "--json=yes"},
      {"make"},
      {"make", "cube"},
      {"make", "-o", "a.ply"},
      {"make", "cube", "-o"},
      {"make", "cube", "-o", "--json"},
      {"make", "cube", "-o", "a.ply", "-o", "b.ply"},
      {"make", "cube", "-o", "a.xyz"},
      {"make", "cube", "-o", "a"},
      {"make", "cube", "-o", "-"},
      {"make", "cube", "-o", "-", "--format", "ply", "--json"},
      {"refine", "a.ply", "-o", "b.ply"},
      {"refine", "a.ply", "-o", "b.ply", "--criterion", "distance"},
      {"refine", "a.ply", "-o", "b.ply", "--criterion", "uniform", "--pixels", "1"},
      {"refine", "a.ply", "-o", "b.ply", "--eye", "0,0,1", "--view", "0,0"},
      {"refine", "a.ply", "-o", "b.ply", "--view", "0,0", "--fov", "30", "--ortho"},
      {"refine", "a.ply", "-o", "b.ply", "--view", "0,0", "--near", "1", "--far", "2"},
      {"render", "a.ply"},
      {"render", "a.ply", "-o", "b.jpg"},
      {"render", "a.ply", "-o", "b"},
      {"render", "a.ply", "-o", "-", "--json"},
      {"compare", "a.ply"},
      {"compare", "-", "-"},
      {"compare", "a.ply", "b.ply", "--fail-if", "mean>1"},
      {"help", "nothing"},
      {"man", "nothing"},
      {"completion"},
      {"completion", "csh"},
      {"demo", "extra"},
      {"demo", "-o", "demo.jpg"},
      {"demo", "--size", "2x2"},
      {"version", "extra"}};
  for (const Arguments& words : cases) {
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 2) << testing::PrintToString(words) << outcome.err;
    EXPECT_EQ(outcome.out, "") << testing::PrintToString(words);
    EXPECT_NE(outcome.err, "") << testing::PrintToString(words);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST_F(Frame, ExitsWith3WhereAFileCannotBeReadOrWritten) {
  folder.write("broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  folder.write("noise.bin", std::string("\x01\x02\x03\x00\xff", 5));
  ASSERT_EQ(limn.run({"make", "cube", "-o", "cube.ply"}).exit, 0);
  const std::vector<Arguments> cases = {{"info", "missing.ply"},
                                        {"info", "."},
                                        {"info", "broken.ply"},
                                        {"info", "noise.bin"},
                                        {"make", "cube", "-o", "no/such/folder/cube.ply"},
                                        {"refine", "missing.ply", "-o", "a.ply", "--view", "0,0"},
                                        {"refine", "cube.ply", "-o", "no/a.ply", "--view", "0,0"},
                                        {"render", "missing.ply", "-o", "a.png"},
                                        {"compare", "cube.ply", "missing.ply"},
                                        {"compare", "broken.ply", "cube.ply"},
                                        {"demo", "-o", "no/demo.png"}};
  for (const Arguments& words : cases) {
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 3) << testing::PrintToString(words) << outcome.err;
    EXPECT_EQ(outcome.out, "") << testing::PrintToString(words);
    EXPECT_NE(outcome.err, "") << testing::PrintToString(words);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
}

TEST_F(Frame, ExitsWith4WhereAMeshCannotBeUsed) {
  folder.write("empty.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  folder.write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(limn.run({"make", "cube", "-o", "cube.ply"}).exit, 0);
  const std::vector<Arguments> cases = {{"refine", "empty.obj", "-o", "a.ply", "--view", "0,0"},
                                        {"render", "empty.obj", "-o", "a.png"},
                                        {"compare", "empty.obj", "cube.ply"},
                                        {"compare", "cube.ply", "empty.obj"},
                                        {"info", "nan.obj"},
                                        {"refine", "cube.ply", "-o", "a.ply", "--criterion", "tags"}};
  for (const Arguments& words : cases) {
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 4) << testing::PrintToString(words) << outcome.err;
    EXPECT_NE(outcome.err, "") << testing::PrintToString(words);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_F(Frame, PrintsTheVersionInEveryCustomaryWay) {
  const Outcome outcome = limn.run({"version"});
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_EQ(outcome.out, "limn " LIMN_VERSION "\n");
  EXPECT_EQ(limn.run({"--version"}).out, outcome.out);
}

TEST_F(Frame, KeepsMessagesOffStandardOutputAndSilentWhenQuiet) {
  const Outcome loud = limn.run({"make", "cube", "-o", "cube.ply"});
  EXPECT_EQ(loud.out, "");
  EXPECT_EQ(std::count(loud.err.begin(), loud.err.end(), '\n'), 1) << loud.err;
  const Outcome quiet = limn.run({"make", "cube", "-o", "cube.ply", "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_NE(limn.run({"info", "missing.ply", "--quiet"}).err, "");
}

TEST_F(Frame, GivesTheSameResultForAnyNumberOfThreads) {
  const auto refined = [&](const std::string& threads) {
    const std::string name = "fine" + threads + ".ply";
    EXPECT_EQ(limn.run({"refine", "knot.ply", "-o", name, "--view", "30,20", "--threads", threads}).exit, 0);
    return slurp(folder / name);
  };
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "2000", "-o", "knot.ply"}).exit, 0);
  EXPECT_TRUE(refined("1") == refined("3"));
}

TEST_F(Frame, ColoursErrorsOnATerminalUnlessToldNotTo) {
  limn.environment = {{"TERM", "xterm"}, {"NO_COLOR", ""}};
  EXPECT_NE(limn.run_on_terminal({"nothing"}).err.find("\x1b["), std::string::npos);
  limn.environment["NO_COLOR"] = "1";
  EXPECT_EQ(limn.run_on_terminal({"nothing"}).err.find("\x1b["), std::string::npos);
  limn.environment["NO_COLOR"] = "";
  EXPECT_EQ(limn.run({"nothing"}).err.find("\x1b["), std::string::npos);
}

TEST_F(Frame, PrintsAManualPageForTheProgramAndEveryVerb) {
  EXPECT_TRUE(limn.run({"man"}).out.starts_with(".TH LIMN 1"));
  for (const auto& verb : limn.json({"help"})["verbs"]) {
    const std::string page = limn.run({"man", verb["name"]}).out;
    EXPECT_TRUE(page.starts_with(".TH LIMN\\-") || page.starts_with(".TH LIMN-")) << page.substr(0, 30);
    EXPECT_NE(page.find(".SH EXAMPLES"), std::string::npos);
    EXPECT_EQ(std::count(page.begin(), page.end(), '\n') > 20, true);
  }
}

}  // namespace
}  // namespace limn::test
