// Picture files: what is written is read again, and what cannot be read or written is said in one line.
#include "renderer/image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) / ("parafovea_image_" + std::to_string(getpid()) + "_" + name);
}

std::string failure_of(const std::function<void()>& f) {
    try {
        f();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(Image, PngComesBackAsWritten) {
    Image image = noise_picture({37, 11});
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    const std::filesystem::path path = temporary("round_trip.png");
    save_png(image, path);
    EXPECT_TRUE(load_image(path) == image);
    std::filesystem::remove(path);
}

TEST(Image, SaysInOneLineWhatIsWrongWithAFile) {
    const std::filesystem::path missing = temporary("missing.png");
    EXPECT_NE(failure_of([&] { load_image(missing); }).find(missing.string()), std::string::npos);
    EXPECT_NE(failure_of([] { load_image(testing::TempDir()); }).find("folder"), std::string::npos);

    const std::filesystem::path text = temporary("text.png");
    std::ofstream(text) << "not a picture";
    EXPECT_NE(failure_of([&] { load_image(text); }).find("neither a PNG nor a JPEG"), std::string::npos);

    const std::filesystem::path whole = temporary("whole.png"), cut = temporary("cut.png");
    save_png(noise_picture({40, 40}), whole);
    std::ifstream file(whole, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (const std::size_t length : {std::size_t{4}, std::size_t{20}, std::size_t{60}, bytes.size() / 2}) {
        std::ofstream(cut, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(length));
        const std::string message = failure_of([&] { load_image(cut); });
        EXPECT_NE(message.find("broken"), std::string::npos) << length;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    for (const std::filesystem::path& path : {text, whole, cut}) std::filesystem::remove(path);
}

TEST(Image, SaysInOneLineThatAFileCannotBeWritten) {
    const std::string message = failure_of([] {
        save_png(noise_picture({2, 2}), "/nonexistent/folder/a.png");
    });
    EXPECT_NE(message.find("/nonexistent/folder/a.png"), std::string::npos);
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace parafovea
