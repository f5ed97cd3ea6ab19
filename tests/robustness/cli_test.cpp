/// The program under bad input: one clear sentence, the right exit code, and nothing half-written left behind.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "relievo/image.hpp"
#include "support/child.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;

const std::string good_rays = "u,v,h,du,dv,dh\n0.1,0.2,1,0.3,0.1,-1\n0.5,0.5,1,0,0,-1\n";
const std::map<std::string, std::string> no_vulkan = {{"VK_DRIVER_FILES", "/nonexistent"},
                                                      {"VK_ICD_FILENAMES", "/nonexistent"}};
const std::map<std::string, std::string> no_egl = {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent"}};

/// A folder with good input to break one thing at a time.
class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    const HeightMap map = smooth_noise_map(12, 8);
    ASSERT_TRUE(write_pfm(folder_ / "height.pfm", Image{map.width, map.height, 1, map.texels}));
    folder_.write("rays.csv", good_rays);
    folder_.write("scene.toml", "[image]\nwidth = 16\nheight = 16\n");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::vector<std::string> trace(const std::string& height, const std::string& rays,
                                 std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"trace",  "--technique", "relief", "--height",      height,
                                      "--rays", rays,          "-o",     path("hits.csv")};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::vector<std::string> compile_user(std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"compile",  "mine",     "-I", path("techniques"),
                                      "--target", "glsl-450", "-o", path("compiled")};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// A technique of a user, with the descriptor's tail and the GLSL as given.
  void write_technique(const std::string& tail, const std::string& glsl) const {
    fs::create_directories(folder_ / "techniques/mine");
    folder_.write("techniques/mine/technique.toml",
                  "schema = 1\nname = \"mine\"\ntitle = \"Mine\"\nclass = \"unsafe\"\nfirst_hit = \"never\"\n"
                  "module = \"mine.glsl\"\n" +
                      tail);
    folder_.write("techniques/mine/mine.glsl", glsl);
  }

  std::set<std::string> listing() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) names.insert(entry.path().string());
    return names;
  }

  /// The program must end with `exit_code`, say all of `parts` in one sentence on stderr, and leave the folder as it
  /// was.
  void expect_refused(const std::vector<std::string>& arguments, int exit_code, const std::vector<std::string>& parts,
                      const std::map<std::string, std::string>& variables = {}, const std::string& input = {}) const {
    std::string command;
    for (const std::string& word : arguments) command += word + " ";
    SCOPED_TRACE(command);
    const auto before = listing();
    const ChildResult result = run_relievo(arguments, variables, input);
    EXPECT_EQ(result.signal, 0) << "ended by a signal";
    EXPECT_EQ(result.exit_code, exit_code) << result.err << result.out;
    for (const std::string& part : parts)
      EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
    EXPECT_LE(result.err.size(), 2000U) << "more than a sentence";
    EXPECT_FALSE(result.err.empty()) << "says nothing";
    EXPECT_EQ(result.out, "") << "errors go to stderr";
    EXPECT_EQ(listing(), before) << "leaves something behind";
  }

  TemporaryFolder folder_;
};

const std::string good_glsl =
    "#include \"shaders/lib/interval.glsl\"\n\n"
    "Hit mine_trace(Ray ray) { return relievo_hit_at(ray, RELIEVO_MISS, 0.0); }\n";

TEST_F(Cli, HitsFarAwayAreWrittenWithAllTheirDigits) {
  folder_.write("rays.csv", "u,v,h,du,dv,dh\n70000.40625,0.5,1,0.25,0,-1\n");
  std::vector<double> u;
  for (const char* backend : {"oracle", "vulkan"}) {
    const ChildResult traced = run_relievo({"trace", "--technique", "exact", "--height", path("height.pfm"), "--rays",
                                            path("rays.csv"), "--backend", backend, "-o", path("hits.csv")});
    ASSERT_EQ(traced.exit_code, 0) << traced.err;
    const std::string hits = TemporaryFolder::read(path("hits.csv"));
    u.push_back(std::stod(hits.substr(hits.find(',', hits.find(',', hits.find('\n')) + 1) + 1)));
  }
  EXPECT_GT(u[0], 70000.4);
  EXPECT_NEAR(u[0], u[1], 1e-6) << "nine digits leave five behind the point";
}

TEST_F(Cli, GoodInputSucceeds) {
  const ChildResult traced = run_relievo(trace(path("height.pfm"), path("rays.csv")));
  EXPECT_EQ(traced.exit_code, 0) << traced.err;
  EXPECT_EQ(TemporaryFolder::read(path("hits.csv")).substr(0, 28), "status,t,u,v,h,steps,fetches");
  write_technique("", good_glsl);
  EXPECT_EQ(run_relievo(compile_user()).exit_code, 0);
  EXPECT_EQ(run_relievo({"--help"}).exit_code, 0);
  using Words = std::vector<std::string>;
  for (Words command :
       {Words{"list"}, Words{"describe"}, Words{"compile"}, Words{"bake"}, Words{"certify"}, Words{"trace"},
        Words{"render"}, Words{"bench"}, Words{"conform"}, Words{"permute"}, Words{"report"}, Words{"archive", "list"},
        Words{"archive", "find"}, Words{"archive", "verify"}, Words{"archive", "merge"}, Words{"cache", "stats"},
        Words{"cache", "verify"}, Words{"cache", "clear"}}) {
    SCOPED_TRACE(command.front() + " " + command.back());
    command.push_back("--help");
    const ChildResult help = run_relievo(command);
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("--json"), std::string::npos) << help.out;
  }
}

TEST_F(Cli, HeightFilesThatAreNone) {
  const std::string whole = TemporaryFolder::read(path("height.pfm"));
  folder_.write("truncated.pfm", whole.substr(0, whole.size() / 2));
  folder_.write("empty.png", "");
  folder_.write("text.png", "this is not an image");
  folder_.write("huge.pfm", "Pf\n200000 200000\n-1.0\n");
  const float nan = std::nanf("");
  std::string bad = whole;
  std::memcpy(bad.data() + bad.size() - 8, &nan, 4);
  folder_.write("nan.pfm", bad);
  for (const char* name : {"missing.png", "truncated.pfm", "empty.png", "text.png", "huge.pfm", "nan.pfm", "."})
    expect_refused(trace(path(name), path("rays.csv")), 1, {path(name), "[image."});
  expect_refused(trace(path("huge.pfm"), path("rays.csv")), 1, {"200000", "16384"});
  expect_refused({"bake", "normal", "--height", path("missing.png"), "-o", path("n.exr")}, 1, {"missing.png"});
}

TEST_F(Cli, UnknownNamesAreAnsweredWithTheNearest) {
  const auto h = path("height.pfm"), r = path("rays.csv");
  expect_refused({"trace", "--technique", "releif", "--height", h, "--rays", r}, 1,
                 {"releif", "the nearest is \"relief\""});
  expect_refused(trace(h, r, {"--backend", "vulcan"}), 1, {"vulcan", "vulkan"});
  expect_refused({"compile", "relief", "--target", "hlsl-5.5"}, 1, {"hlsl-5.5", "hlsl-5."});
  expect_refused({"compile", "relief", "--target", "glsl-450", "--stage", "surfaces"}, 1, {"surfaces", "surface"});
  expect_refused(trace(h, r, {"--set", "relief.linear_stepz=3"}), 1, {"linear_stepz", "'relief.linear_steps'"});
  expect_refused(trace(h, r, {"--set", "linear_steps"}), 1, {"linear_steps", "name=value"});
  expect_refused(trace(h, r, {"--set", "linear_steps=many"}), 1, {"many", "number"});
  expect_refused(trace(h, r, {"--set", "linear_steps=0"}), 1, {"relief.linear_steps", "1 to 65536"});
  expect_refused(trace(h, r, {"--set", "linear_steps=2.5"}), 1, {"relief.linear_steps", "whole"});
  expect_refused(trace(h, r, {"--address", "repat"}), 1, {"repat", "repeat"});
  expect_refused(trace(h, r, {"--filter", "exakt"}), 1, {"exakt", "exact"});
  expect_refused({"bake", "normals", "--height", h, "-o", path("n.exr")}, 1, {"normals", "normal"});
  expect_refused({"bake", "height", "--height", h, "-o", path("n.exr")}, 1, {"height"});
  expect_refused({"describe", "surfice"}, 1, {"surfice", "surface"});
  expect_refused({"render", path("scene.toml"), "--technique", "relief", "--aov", "colour", "-o", path("p.png")}, 1,
                 {"colour", "color"});
  expect_refused({"trase"}, 1, {"trase"});
  expect_refused({}, 1, {"subcommand"});
  expect_refused({"trace"}, 1, {"--height"});
}

TEST_F(Cli, TechniquesAndFormatsThatATraceOrPictureCannotHaveAreSaid) {
  const auto h = path("height.pfm"), r = path("rays.csv");
  expect_refused({"trace", "--height", h, "--rays", r}, 1, {"[trace.no-technique]", "--technique NAME"});
  expect_refused({"trace", "--technique", "oracle", "--height", h, "--rays", r}, 1,
                 {"[trace.oracle]", "--backend oracle"});
  expect_refused({"render", path("scene.toml"), "--technique", "relief", "-o", path("p.tiff")}, 1,
                 {"[render.format]", ".tiff", ".png or .exr"});
}

TEST_F(Cli, RaysThatAreNone) {
  const auto refused = [&](const std::string& content, const std::vector<std::string>& parts) {
    folder_.write("bad.csv", content);
    expect_refused(trace(path("height.pfm"), path("bad.csv")), 1, parts);
  };
  refused("u,v,h,du,dv\n0,0,1,0,0\n", {"bad.csv:1", "header"});
  refused("x,y,z,du,dv,dh\n0,0,1,0,0,-1\n", {"bad.csv:1", "header"});
  refused("u,v,h,du,dv,dh\n0,0,1,0,0\n", {"bad.csv:2", "5 values"});
  refused("u,v,h,du,dv,dh\n0,0,1,0,0,-1\n0,0,1,0,0,down\n", {"bad.csv:3:11", "'down'"});
  refused("u,v,h,du,dv,dh\n0.1,   0.2,   oops,1,1,1\n", {"bad.csv:2:15", "'oops'"});
  refused("u,v,h,du,dv,dh\n", {"bad.csv", "no rays"});
  refused("", {"bad.csv"});
  expect_refused(trace(path("height.pfm"), path("missing.csv")), 1, {"missing.csv"});
  expect_refused(trace(path("height.pfm"), path("")), 1, {});
  expect_refused(trace(path("height.pfm"), "-"), 1, {"<stdin>"}, {}, "nonsense\n");
}

TEST_F(Cli, FoldersThatCannotBeWritten) {
  folder_.write("file", "");
  const auto h = path("height.pfm"), r = path("rays.csv");
  expect_refused({"trace", "--technique", "relief", "--height", h, "--rays", r, "-o", path("none/hits.csv")}, 1,
                 {"none/hits.csv"});
  expect_refused({"compile", "relief", "--target", "glsl-450", "-o", path("file/x")}, 1, {"file/x"});
  expect_refused({"bake", "normal", "--height", h, "-o", path("none/n.exr")}, 1, {"none/n.exr"});
  expect_refused({"bake", "normal", "--height", h, "-o", path("n.tiff")}, 1, {".tiff", ".exr"});
  expect_refused({"render", path("scene.toml"), "--technique", "relief", "-o", path("none/p.png")}, 1, {"none/p.png"});
}

TEST_F(Cli, MissingDriversAreUnsupportedAndNamed) {
  const auto h = path("height.pfm"), r = path("rays.csv");
  expect_refused(trace(h, r, {"--backend", "vulkan"}), 3, {"Vulkan"}, no_vulkan);
  expect_refused(trace(h, r, {"--backend", "opengl"}), 3, {"EGL"}, no_egl);
  auto neither = no_vulkan;
  neither.insert(no_egl.begin(), no_egl.end());
  const ChildResult list = run_relievo({"list", "backends", "--json"}, neither);
  EXPECT_EQ(list.exit_code, 0) << "the program starts on a machine without drivers";
  const auto json = nlohmann::json::parse(list.out, nullptr, false);
  ASSERT_TRUE(json.contains("backends")) << list.out;
  int missing = 0;
  for (const auto& entry : json["backends"])
    missing += !entry["available"] && !entry["reason"].get<std::string>().empty();
  EXPECT_GE(missing, 2);
  const ChildResult oracle = run_relievo(trace(h, r, {"--backend", "oracle"}), neither);
  EXPECT_EQ(oracle.exit_code, 0) << oracle.err;
  expect_refused({"conform", "--height", h}, 3, {"no backend"}, neither);
}

TEST_F(Cli, ScenesAndMeshesThatAreNone) {
  folder_.write("no_uv.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder_.write("no_uv.toml", "[mesh]\nkind = \"file\"\npath = \"no_uv.obj\"\n");
  folder_.write("bad.toml", "[camera]\npositon = [0, 0, 1]\n");
  folder_.write("lost.toml", "[mesh]\nkind = \"file\"\npath = \"lost.obj\"\n");
  folder_.write("broken.toml", "[camera\n");
  const auto render = [&](const std::string& scene) {
    return std::vector<std::string>{"render", path(scene), "--technique", "relief", "-o", path("p.png")};
  };
  expect_refused(render("no_uv.toml"), 1, {"no_uv.obj"});
  expect_refused(render("bad.toml"), 1, {"bad.toml:2", "positon", "position"});
  expect_refused(render("lost.toml"), 1, {"lost.obj"});
  expect_refused(render("broken.toml"), 1, {"broken.toml:1"});
  expect_refused(render("missing.toml"), 1, {"missing.toml"});
  expect_refused({"render", path("scene.toml"), "--technique", "relief", "--stage", "ray", "-o", path("p.png")}, 1,
                 {"ray", "surface"});
  expect_refused({"render", path("scene.toml"), "-o", path("p.png")}, 1, {});
  expect_refused({"render", path("scene.toml"), "--technique", "oracle", "--stage", "vertex", "-o", path("p.png")}, 3,
                 {"vertex", "tessellated"});
}

TEST_F(Cli, ATechniqueThatDoesNotCompileIsNamedByFileAndLine) {
  write_technique("", good_glsl + "float mine_bad() { return missing_name; }\n");
  expect_refused(compile_user(), 2, {path("techniques/mine/mine.glsl") + ":4", "missing_name"});
  std::vector<std::string> words = trace(path("height.pfm"), path("rays.csv"), {"-I", path("techniques")});
  words[2] = "mine";
  expect_refused(words, 2, {path("techniques/mine/mine.glsl") + ":4", "missing_name"});
  write_technique("", "float mine_other() { return 1.0; }\n");
  expect_refused(compile_user(), 2, {"mine_trace"});
  fs::create_directories(folder_ / "techniques/mine");
  folder_.write("techniques/mine/second.glsl", "float mine_a() { return 1.0; }\n\nfloat mine_b() { return 1.0 }\n");
  write_technique("", "#include \"second.glsl\"\n" + good_glsl);
  expect_refused(compile_user(), 2, {"second.glsl:3"});
}

TEST_F(Cli, IncludesThatEscapeOrLoopAreNamedByFileAndLine) {
  write_technique("", good_glsl + "#include \"../outside.glsl\"\n");
  expect_refused(compile_user(), 2, {"mine.glsl:4", "../outside.glsl"});
  write_technique("", good_glsl + "#include \"/etc/passwd\"\n");
  expect_refused(compile_user(), 2, {"mine.glsl:4", "/etc/passwd"});
  write_technique("", good_glsl + "#include \"shaders/lib/serch.glsl\"\n");
  expect_refused(compile_user(), 2, {"mine.glsl:4", "shaders/lib/search.glsl"});
  write_technique("", good_glsl + "#include \"mine.glsl\"\n");
  expect_refused(compile_user(), 2, {"mine.glsl:4"});
}

TEST_F(Cli, DescriptorsThatContradictThemselves) {
  const std::string loop = "[loops.steps]\ntitle = \"Steps\"\nbounds = \"steps\"\n";
  write_technique(loop + "min = 9\nmax = 3\ndefault = 4\n", good_glsl);
  expect_refused(compile_user(), 1, {"technique.toml", "9", "3"});
  write_technique("maps = [\"nobodys\"]\n", good_glsl);
  expect_refused(compile_user(), 1, {"technique.toml:7", "nobodys"});
  write_technique("titel = \"x\"\n", good_glsl);
  expect_refused(compile_user(), 1, {"technique.toml:7", "titel", "title"});
  expect_refused({"list", "-I", path("no_such_folder")}, 1, {"no_such_folder"});
}

TEST_F(Cli, PrismIsRefusedForHlslWithItsFallbackNamed) {
  expect_refused({"compile", "relief", "--stage", "prism", "--target", "hlsl-5.0"}, 3, {"hlsl-5.0", "prism_pulled"});
  expect_refused({"compile", "relief", "--stage", "ray", "--target", "glsl-330"}, 3, {"glsl-330", "glsl-430"});
}

/// A technique that claims first hits and finds none draws a prism without a silhouette.
TEST_F(Cli, ConformExitsWithFourWhenAClaimFails) {
  write_technique("", good_glsl);
  const std::string descriptor = TemporaryFolder::read(path("techniques/mine/technique.toml"));
  const std::size_t claim = descriptor.find("\"never\"");
  ASSERT_NE(claim, std::string::npos);
  folder_.write("techniques/mine/technique.toml", std::string(descriptor).replace(claim, 7, "\"always\""));
  folder_.write("ball.toml", "[mesh]\nkind = \"sphere\"\n[image]\nwidth = 48\nheight = 48\n");
  const auto conform = [&](const std::string& technique) {
    return run_relievo({"conform", "-I", path("techniques"), "--techniques", technique, "--scene", path("ball.toml"),
                        "--repeats", "1"});
  };
  const ChildResult liar = conform("mine"), honest = conform("relief");
  EXPECT_EQ(liar.exit_code, 4) << liar.out << liar.err;
  EXPECT_NE(liar.err.find("checks fail"), std::string::npos) << liar.err;
  EXPECT_NE(liar.out.find("FAIL prism silhouette"), std::string::npos) << liar.out;
  EXPECT_EQ(honest.exit_code, 0) << honest.out << honest.err;
}

TEST_F(Cli, ErrorsAreJsonWhenAskedFor) {
  const ChildResult result = run_relievo(trace(path("missing.png"), path("rays.csv"), {"--json"}));
  EXPECT_EQ(result.exit_code, 1);
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(json.contains("error")) << result.out;
  EXPECT_EQ(json["error"]["exit_code"], 1);
  EXPECT_EQ(json["error"]["id"].get<std::string>().substr(0, 6), "image.");
  EXPECT_NE(json["error"]["message"].get<std::string>().find("missing.png"), std::string::npos);
}

/// Ranges let NaN pass, for it is neither below nor above.
TEST_F(Cli, NumbersThatAreNotFiniteAreRefused) {
  const auto h = path("height.pfm");
  for (const std::string number : {"nan", "-nan", "inf"}) {
    expect_refused({"certify", "max_pyramid", "--height", h, "--tolerance", number}, 1, {"--tolerance", number});
    expect_refused({"bench", "--techniques", "relief", "--height", h, "--angle", number}, 1, {"--angle"});
    expect_refused({"bench", "--techniques", "relief", "--height", h, "--scale", number}, 1, {"--scale"});
  }
  expect_refused({"conform", "--fuzz", "64", "--patience", "1e300"}, 1, {"--patience", "1e300"});
  expect_refused({"conform", "--techniques", "relief", "--height", h + ":0.1-9"}, 1, {"0.1-9", "FILE:scale"});
}

TEST_F(Cli, PipesAndLinksAreWrittenAndNotReplaced) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int both_ends = ::open(path("pipe").c_str(), O_RDWR | O_NONBLOCK);  // neither side waits for the other
  ASSERT_GE(both_ends, 0);
  std::vector<std::string> words = trace(path("height.pfm"), path("rays.csv"));
  words.back() = path("pipe");
  EXPECT_EQ(run_relievo(words).exit_code, 0);
  std::string arrived(4096, '\0');
  arrived.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(both_ends, arrived.data(), arrived.size()))));
  ::close(both_ends);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_EQ(arrived.substr(0, 7), "status,");

  folder_.write("target.csv", "old");
  fs::create_symlink("target.csv", path("link.csv"));
  words.back() = path("link.csv");
  EXPECT_EQ(run_relievo(words).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(path("link.csv")));
  EXPECT_EQ(TemporaryFolder::read(path("target.csv")), arrived);
  fs::create_symlink("nowhere.csv", path("dangling.csv"));
  words.back() = path("dangling.csv");
  EXPECT_EQ(run_relievo(words).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(path("dangling.csv")));
  EXPECT_EQ(TemporaryFolder::read(path("nowhere.csv")), arrived);
}

TEST_F(Cli, LinksThatLeadNowhereButToThemselvesAreRefusedAndStay) {
  fs::create_symlink("b.csv", path("a.csv"));
  fs::create_symlink("a.csv", path("b.csv"));
  std::vector<std::string> words = trace(path("height.pfm"), path("rays.csv"));
  words.back() = path("a.csv");
  expect_refused(words, 1, {"a.csv", "cannot be written", std::strerror(ELOOP)});
  EXPECT_EQ(fs::read_symlink(path("a.csv")), "b.csv");
  EXPECT_EQ(fs::read_symlink(path("b.csv")), "a.csv");
}

const std::string program = RELIEVO_BINARY_DIR "/bin/relievo";

TEST_F(Cli, WhatCannotBePrintedIsNoSuccess) {
  const ChildResult full = run_child("/bin/sh", {"-c", "\"$0\" list --json > /dev/full", program});
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_NE(full.err.find("cli.write"), std::string::npos) << full.err;
}

TEST_F(Cli, WithoutMemoryThereIsASentence) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's shadow memory is beyond any limit";
#endif
  const ChildResult starved = run_child(
      "/bin/sh", {"-c", "ulimit -v 1500000; exec \"$0\" trace --technique relief --height /dev/zero --rays \"$1\"",
                  program, path("rays.csv")});
  EXPECT_EQ(starved.signal, 0);
  EXPECT_EQ(starved.exit_code, 1);
  EXPECT_NE(starved.err.find("image.memory"), std::string::npos) << starved.err;
}

TEST_F(Cli, JsonStandsNamesThatAreNoText) {
  const ChildResult result = run_relievo(trace("b\xff.png", path("rays.csv"), {"--json"}));
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(json.contains("error")) << result.out << result.err;
  EXPECT_EQ(json["error"]["id"], "image.missing");
}

TEST_F(Cli, CompileGivesEachTechniqueWhatItHas) {
  const auto compiled = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "compile");
    words.insert(words.end(), {"--target", "glsl-450", "-o", path("out"), "-MF", path("out.d")});
    const ChildResult result = run_relievo(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return TemporaryFolder::read(path("out/relief.surface.frag.glsl-450.glsl"));
  };
  write_technique("", good_glsl);
  const std::string both = compiled({"relief", "mine", "-I", path("techniques"), "-D", "relief.linear_steps=5"});
  const std::string depfile = TemporaryFolder::read(path("out.d"));
  EXPECT_NE(depfile.find("relief.surface.json:"), std::string::npos) << depfile;
  EXPECT_NE(depfile.find("mine.surface.json:"), std::string::npos) << depfile;
  EXPECT_NE(depfile.find(path("techniques/mine/mine.glsl")), std::string::npos) << depfile;
  EXPECT_EQ(depfile.find("shaders/lib"), std::string::npos) << "no such file is there to be looked for: " << depfile;
  EXPECT_EQ(both, compiled({"relief", "-D", "linear_steps=5"}));
  EXPECT_NE(both, compiled({"relief"}));
  EXPECT_EQ(compiled({"relief", "--set", "relief.filter=hardware"}), compiled({"relief", "--filter", "hardware"}));
  EXPECT_EQ(compiled({"relief", "-D", "relief.filter=hardware"}), compiled({"relief", "--filter", "hardware"}));
  expect_refused({"compile", "relief", "parallax", "--bind", "relief.linear_stepz=macro", "--target", "glsl-450"}, 1,
                 {"relief.linear_stepz", "relief.linear_steps"});
}

/// What expect_refused looks for does fail on a run that succeeds or leaves files.
TEST_F(Cli, ASuccessfulRunChangesTheListing) {
  const auto before = listing();
  EXPECT_EQ(run_relievo(trace(path("height.pfm"), path("rays.csv"))).exit_code, 0);
  EXPECT_NE(listing(), before);
}

}  // namespace
}  // namespace relievo::test
