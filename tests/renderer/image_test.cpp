// Picture files: what is written is read again, and what cannot be read or written is said in one line.
#include "renderer/image.h"

#include <gtest/gtest.h>

#include "tests/message_of.h"
#include "tests/renderer/picture_method.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

TEST(Image, PngComesBackAsWritten) {
    Image image = noise_picture({37, 11});
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    const TemporaryFolder folder;
    save_png(image, folder / "round_trip.png");
    EXPECT_TRUE(load_image(folder / "round_trip.png") == image);
}

TEST(Image, SaysInOneLineWhatIsWrongWithAFile) {
    const TemporaryFolder folder;
    const std::filesystem::path missing = folder / "missing.png";
    EXPECT_NE(message_of([&] { load_image(missing); }).find(missing.string()), std::string::npos);
    EXPECT_NE(message_of([&] { load_image(folder.path()); }).find("folder"), std::string::npos);

    const std::filesystem::path text = folder.write("text.png", "not a picture");
    EXPECT_NE(message_of([&] { load_image(text); }).find("neither a PNG nor a JPEG"), std::string::npos);

    const std::filesystem::path whole = folder / "whole.png";
    save_png(noise_picture({40, 40}), whole);
    const std::string bytes = text_of(whole);
    for (const std::size_t length : {std::size_t{4}, std::size_t{20}, std::size_t{60}, bytes.size() / 2}) {
        const std::filesystem::path cut = folder.write("cut.png", bytes.substr(0, length));
        const std::string message = message_of([&] { load_image(cut); });
        EXPECT_NE(message.find("broken"), std::string::npos) << length;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(Image, SaysInOneLineThatAFileCannotBeWritten) {
    const std::string message = message_of([] {
        save_png(noise_picture({2, 2}), "/nonexistent/folder/a.png");
    });
    EXPECT_NE(message.find("/nonexistent/folder/a.png"), std::string::npos);
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace parafovea
