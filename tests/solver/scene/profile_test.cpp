#include "tests/solver/scene/scene_folder.hpp"

namespace slurry::test {
namespace {

class Profile : public SceneFolder {
  protected:
    [[nodiscard]] std::vector<Vector> points(const std::string& csv) const {
        write("profile.csv", csv);
        return std::get<ProfileShape>(read(full_scene).walls[5].shape).points;
    }
    [[nodiscard]] std::string refusal_of(const std::string& csv) const {
        write("profile.csv", csv);
        return refusal(full_scene);
    }
};

TEST_F(Profile, ReadsTwoColumns) {
    const std::vector<Vector> expected{Vector(-1e-6, 2), Vector(0, 2.5)};
    EXPECT_EQ(points("-1e-6,2\n0,2.5"), expected);
    EXPECT_EQ(points("\xEF\xBB\xBF# x, y\r\n\r\n -1e-6 ,\t2 # first\r\n  # note\r\n0,2.5\r\n"), expected);
}

TEST_F(Profile, RefusesWithFileAndLine) {
    EXPECT_EQ(refusal_of("0, 1\nx, y\n"),
              "profile.csv:2: found \"x, y\", allowed two finite numbers x, y (m), or # before a comment");
    for (const char* line :
         {"1", "1,", ",1", "1,2,3", "1;2", "1 2", "1,nan", "inf,1", "1,1e999", "1,2x", "1,0x10", "+1,2"}) {
        EXPECT_TRUE(
            refusal_of(std::string("# comment\n0, 1\n\n") + line).starts_with("profile.csv:4: found "))
            << line;
    }
    EXPECT_EQ(refusal_of("0,1\n2,1\n2,3\n"), "profile.csv:3: found x = 2 after 2, allowed ascending x");
}

TEST_F(Profile, RefusesTooFewPoints) {
    EXPECT_EQ(refusal_of("# nothing\n"),
              "scene.toml:64:8: found profile.csv with 0 points, allowed at least 2");
    EXPECT_EQ(refusal_of("0, 1\n"), "scene.toml:64:8: found profile.csv with 1 points, allowed at least 2");
}

TEST_F(Profile, ThatIsMissingIsSaidToBeMissingInTheSceneOfTheWorkingFolder) {
    write("scene.toml", replaced(full_scene, "\"profile.csv\"", "\"absent.csv\""));
    write("sizes.toml", replaced(replaced(full_scene, "count = 3\nradius = 0.4",
                                          "count = 3\nradius = 0\nsizes = \"file\"\nfile = \"absent.csv\""),
                                 "file = \"profile.csv\"", "file = \"./profile.csv\""));
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(path(""));
    for (const char* name : {"scene.toml", "./scene.toml", "sizes.toml"}) {
        try {
            (void)read_scene(name);
            ADD_FAILURE() << "accepted " << name;
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find("found no regular file "), std::string::npos)
                << error.what();
            EXPECT_NE(std::string(error.what()).find("absent.csv"), std::string::npos) << error.what();
        }
    }
    std::filesystem::current_path(before);
}

TEST_F(Profile, StaysInTheFolderUnlessAbsolute) {
    std::filesystem::create_directory(path("below"));
    write("below/pad.csv", "0,1\n1,1\n");
    const auto file = [&](const std::string& name) {
        return std::get<ProfileShape>(
                   read(full_scene, {"walls.profile.file=\"" + name + "\""}).walls[5].shape)
            .file;
    };
    EXPECT_EQ(file("below/pad.csv"), path("below/pad.csv"));
    EXPECT_EQ(file("below/../profile.csv"), path("profile.csv"));
    EXPECT_EQ(file(path("profile.csv").string()), path("profile.csv"));
    const std::string escape = "../" + path("").parent_path().filename().string() + "/profile.csv";
    EXPECT_NE(refusal(full_scene, {"walls.profile.file=\"" + escape + "\""})
                  .find("allowed a file in the scene's folder"),
              std::string::npos);
    std::filesystem::create_symlink("below/pad.csv", path("inside.csv"));
    EXPECT_EQ(file("inside.csv"), path("inside.csv"));
    std::filesystem::create_symlink("/etc/passwd", path("outside.csv"));
    EXPECT_NE(
        refusal(full_scene, {"walls.profile.file=outside.csv"}).find("a link out of the scene's folder"),
        std::string::npos);
    EXPECT_NE(refusal(full_scene, {"walls.profile.file=below"}).find("found no regular file"),
              std::string::npos);
}

} // namespace
} // namespace slurry::test
