// Draws stimuli for the eyes of a headset.
#include "app/eye_pictures.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <stdexcept>

#include "renderer/eye_dominance.h"
#include "renderer/scene_catalog.h"

namespace parafovea {

namespace {

// The numbers of a view, in the order in which they are written.
template <typename View, typename Function>
void for_each_number(View& view, Function take) {
    auto& [q, p] = view.pose;
    for (auto* number : {&q.x, &q.y, &q.z, &q.w, &p.x, &p.y, &p.z}) take(*number);
    for (auto* number : {&view.fov.angleLeft, &view.fov.angleRight, &view.fov.angleUp, &view.fov.angleDown})
        take(*number);
}

template <typename Number>
void write(std::string& text, Number number) {
    char digits[40];
    text.append(text.empty() ? "" : " ").append(digits, std::to_chars(digits, std::end(digits), number).ptr);
}

template <typename Number>
Number read(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) throw std::runtime_error("the headset's eyes: expected a number in their line");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

}  // namespace

CameraView view_of_eye(const XrView& eye, const SceneCamera& camera) {
    const XrQuaternionf& q = eye.pose.orientation;
    const XrVector3f& p = eye.pose.position;
    glm::mat4 head_from_eye = glm::mat4_cast(glm::quat(q.w, q.x, q.y, q.z));
    head_from_eye[3] = glm::vec4(p.x, p.y, p.z, 1);
    CameraView view;
    view.world_from_eye = camera.world_from_camera * head_from_eye;
    view.tan_left = -std::tan(eye.fov.angleLeft);
    view.tan_right = std::tan(eye.fov.angleRight);
    view.tan_up = std::tan(eye.fov.angleUp);
    view.tan_down = -std::tan(eye.fov.angleDown);
    view.near_m = camera.near_m;
    return view;
}

RenderMethod method_of_eye(const Eyes& eyes, std::size_t eye, const RenderMethod& method) {
    if (eyes.views.size() < 2) return method_for_dominant_eye(method);
    // OpenXR counts the left eye first, in the views of a stereo headset and in each pair of quad views.
    return method_for_eye(method, eye % 2 == 0 ? Eye::left : Eye::right);
}

PointPx Eyes::seen_at(std::size_t eye, PointPx on_view) const {
    const Vector3 towards = unit_vector(view().direction_from_point(on_view));
    const double reach = gaze_distance_m / towards.z;
    return picture_point(views[eye], sizes[eye], {towards.x * reach, towards.y * reach, gaze_distance_m});
}

std::string to_text(const Eyes& eyes) {
    std::string text;
    write(text, eyes.views.size());
    write(text, eyes.gaze_distance_m);
    for (std::size_t i = 0; i < eyes.views.size(); ++i) {
        write(text, eyes.sizes[i].width);
        write(text, eyes.sizes[i].height);
        for_each_number(eyes.views[i], [&text](float number) { write(text, number); });
    }
    return text;
}

Eyes parse_eyes(std::string_view text) {
    Eyes eyes;
    const auto count = read<std::size_t>(text);
    if (count < 1 || count > 4) throw std::runtime_error("the headset's eyes: expected one to four");
    eyes.gaze_distance_m = read<double>(text);
    for (std::size_t i = 0; i < count; ++i) {
        const int width = read<int>(text), height = read<int>(text);
        if (width < 1 || height < 1)
            throw std::runtime_error("the headset's eyes: expected a picture of at least one pixel");
        eyes.sizes.push_back({width, height});
        for_each_number(eyes.views.emplace_back(XrView{XR_TYPE_VIEW, nullptr, {}, {}}),
                        [&text](float& number) { number = read<float>(text); });
    }
    return eyes;
}

bool nearly_same(const std::vector<XrView>& a, const std::vector<XrView>& b) {
    constexpr float kTolerance = 1e-4f;  // metres, radians, and half radians of a quaternion
    return std::ranges::equal(a, b, [](const XrView& x, const XrView& y) {
        std::vector<float> numbers;
        for_each_number(x, [&numbers](float number) { numbers.push_back(number); });
        bool same = true;
        auto other = numbers.begin();
        for_each_number(y, [&](float number) { same = same && std::abs(number - *other++) <= kTolerance; });
        return same;
    });
}

struct EyePictures::LoadedScene {
    FrameRenderer renderer;
    SceneCamera camera;
};

EyePictures::EyePictures(Gpu& gpu) : gpu_(gpu) {}

EyePictures::~EyePictures() = default;

EyePictures::LoadedScene& EyePictures::scene_called(const std::string& name) {
    std::unique_ptr<LoadedScene>& loaded = scenes_[name];
    if (!loaded) {
        const Scene data = load_scene(name);
        loaded.reset(new LoadedScene{FrameRenderer(gpu_, data), data.cameras.front()});
    }
    return *loaded;
}

EyePictures::Drawn EyePictures::draw(const Eyes& eyes, std::size_t eye, const Picture& picture,
                                     bool read_pixels) {
    LoadedScene& scene = scene_called(picture.scene);
    RenderedFrame frame = scene.renderer.render(
        eyes.sizes[eye], view_of_eye(eyes.views[eye], scene.camera),
        method_of_eye(eyes, eye, {picture.method.method, picture.method.numbers, picture.method.words}),
        eyes.seen_at(eye, picture.fovea), read_pixels);
    Drawn drawn;
    drawn.image = &scene.renderer.target();
    drawn.use = read_pixels ? kUseTransferSource : kUseColorTarget;
    if (!frame.statistics.passes.empty()) drawn.gpu_ms = frame.statistics.passes.back().ms;
    if (read_pixels) {
        drawn.pixels = RenderedPicture{frame.image.size, std::move(frame.image.rgba), 0};
        drawn.pixels->hash = hash_of_pixels(drawn.pixels->rgba);
    }
    return drawn;
}

std::uint64_t EyePictures::combine(std::uint64_t hash, const RenderedPicture& eye) {
    return std::rotl(hash, 1) ^ eye.hash;
}

}  // namespace parafovea
