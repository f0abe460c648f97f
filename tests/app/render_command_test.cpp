// `parafovea render` from outside: parameters, eyes, frames and contact sheets.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/image.h"
#include "tests/app/child_process.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;

class RenderCommandLine : public testing::Test {
  protected:
    // What the program says, both streams; its exit code is in exit_code_.
    std::string render(const std::string& arguments) {
        const ProgramOutput said =
            run_program(folder_, "render --scene primitives --out a.png --size 96x64 " + arguments);
        exit_code_ = said.exit_code;
        return said.out + said.errors;
    }
    Image picture(const std::string& name = "a.png") const { return load_image(folder_ / name); }

    TemporaryFolder folder_;
    int exit_code_ = 0;
};

TEST_F(RenderCommandLine, SetsAnyParameterOfTheMethod) {
    render("");
    const Image plain = picture();
    ASSERT_EQ(render("--set inset=0.2 --set width_scale=0.5"), "");
    EXPECT_FALSE(picture() == plain);
    ASSERT_EQ(render("--set kernel=sine"), "");
    EXPECT_FALSE(picture() == plain);
    ASSERT_EQ(render("--set sigma=1.8 --set alpha=4"), "");
    EXPECT_TRUE(picture() == plain);
    const std::string unknown = render("--set insett=0.2");
    EXPECT_EQ(exit_code_, 1);
    EXPECT_EQ(unknown, "parafovea: method kfr has no parameter \"insett\"\n");
    render("--set inset");
    EXPECT_EQ(exit_code_, 2);
    render("--set sigma=100");
    EXPECT_EQ(exit_code_, 1);
}

TEST_F(RenderCommandLine, DrawsBothEyesBesideEachOther) {
    ASSERT_EQ(render("--views 2 --eye-fov 54,46,50,48 --gaze-distance-m 0.5 --stats a.json"), "");
    EXPECT_EQ(picture().size, (SizePx{192, 64}));
    std::ifstream file(folder_ / "a.json");
    EXPECT_EQ(nlohmann::json::parse(file).size(), 2U);
    render("--views 2 --eye-fov 54,46");
    EXPECT_EQ(exit_code_, 2);
}

TEST_F(RenderCommandLine, AntiAliasesOverTimeAndPreservesContrast) {
    render("");
    const Image plain = picture();
    ASSERT_EQ(render("--taa 3"), "");
    const Image smooth = picture();
    EXPECT_FALSE(smooth == plain);
    ASSERT_EQ(render("--set taa=3"), "");
    EXPECT_TRUE(picture() == smooth);
    ASSERT_EQ(render("--contrast 0.2"), "");
    EXPECT_FALSE(picture() == plain);
}

TEST_F(RenderCommandLine, WritesTheFramesOfACameraPath) {
    ASSERT_EQ(render("--frames 2 --path-seconds 1 --taa 4"), "");
    EXPECT_TRUE(fs::exists(folder_ / "a_0000.png"));
    EXPECT_FALSE(picture("a_0000.png") == picture("a_0001.png"));
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(RenderCommandLine, WritesContactSheetsWithTheirDensities) {
    ASSERT_EQ(render("--sheet"), "");
    // Two columns of full resolution, three sigmas and six alphas.
    EXPECT_GT(picture().size.width, 2 * 48);
    EXPECT_GT(picture().size.height, 5 * 32);
    EXPECT_GT(picture("a_density.png").size.height, 5 * 32);
}

}  // namespace
}  // namespace parafovea
