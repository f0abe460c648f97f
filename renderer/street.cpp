// Puts the street together. It runs along z from -30 to 18; the roadway is 5.6 m wide, the pavements 2.4 m.
#include "renderer/street.h"

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "renderer/scene_patterns.h"
#include "renderer/street_materials.h"
#include "renderer/street_parts.h"

namespace parafovea {
namespace {

constexpr float kRoad = 2.8f;   // half the roadway
constexpr float kFront = 5.2f;  // x of the houses' fronts
constexpr float kFar = -30, kNear = 18;
constexpr float kGround = 3.9f, kFloor = 3.1f, kBay = 2.6f;
constexpr float kKerb = 0.12f;

glm::mat4 at(float x, float y, float z, float turn_rad = 0) {
    return glm::rotate(glm::translate(glm::mat4(1), {x, y, z}), turn_rad, {0, 1, 0});
}

class Builder {
  public:
    explicit Builder(Scene& scene) : scene_(scene), m_(add_street_materials(scene)) {}

    void build() {
        define_parts();
        pave();
        float from = kFar;
        for (int house = 0; house < 6; ++house, from += 3 * kBay)
            for (float side : {-1.0f, 1.0f}) add_house(house, side, from);
        close_the_far_end();
        lamps_and_trees();
        string_lights();
    }

  private:
    int part(Triangles mesh, const PaintedMaterial& paint) {
        return append_painted(scene_, std::move(mesh), paint);
    }
    void put(int mesh, const glm::mat4& where) { scene_.instances.push_back({mesh, where}); }
    float chance(int i, int j, int k) const {
        return lattice_noise(i, j, 500u + static_cast<std::uint32_t>(k));
    }

    void define_parts() {
        frame_ = part(make_window_frame(1.1f, 1.75f), m_.stone);
        Triangles pane;
        add_panel(pane, {-0.55f, 0, 0.015f}, {1.1f, 0, 0}, {0, 1.75f, 0});
        for (SceneVertex& v : pane.vertices) v.uv = {(v.position.x + 0.55f) / 1.1f, 1 - v.position.y / 1.75f};
        lit_pane_[0] = part(pane, m_.lit_window[0]);
        lit_pane_[1] = part(pane, m_.lit_window[1]);
        dark_pane_ = part(pane, m_.dark_window);
        shutter_ = part(make_shutter(0.56f, 1.75f), m_.wood);
        rail_ = part(make_balcony_rail(1.9f, 0.75f), m_.iron);
        Triangles slab;
        add_box(slab, {-1.0f, -0.16f, 0}, {1.0f, 0, 0.8f});
        balcony_ = part(slab, m_.stone);
        Triangles box;
        add_box(box, {-0.5f, -0.02f, 0.06f}, {0.5f, 0.16f, 0.26f});
        flower_box_ = part(box, m_.wood);
        flowers_ = part(make_leaves(420, {0.52f, 0.2f, 0.15f}, 0.1f, 3), m_.leaf);
        lamp_ = part(make_lamp_post(3.7f), m_.iron);
        panes_ = part(make_lantern_panes(3.7f), m_.glass);
        bulb_ = part(make_ball(0.055f, 12, 8), m_.bulb);
        small_bulb_ = part(make_ball(0.035f, 10, 6), m_.bulb);
        chair_ = part(make_cafe_chair(), m_.iron);
        table_ = part(make_cafe_table(), m_.iron);
        bottle_ = part(make_bottle(), m_.bottle);
        wine_glass_ = part(make_wine_glass(), m_.glass);
        trunk_ = part(make_trunk(3.2f, 9), m_.wood);
        crown_ = part(make_leaves(11000, {1.7f, 1.3f, 1.7f}, 0.17f, 5), m_.leaf);
        bush_ = part(make_leaves(1900, {0.38f, 0.42f, 0.38f}, 0.12f, 6), m_.leaf);
        Triangles tub;
        const std::vector<glm::vec2> profile{{0.0f, 0.0f},   {0.22f, 0.0f},  {0.3f, 0.42f}, {0.33f, 0.42f},
                                             {0.33f, 0.48f}, {0.27f, 0.48f}, {0.26f, 0.4f}, {0.0f, 0.4f}};
        add_lathe(tub, profile, 24, false);
        tub_ = part(tub, m_.stone);
        for (std::uint32_t i = 0; i < 2; ++i) awning_[i] = part(make_awning(2.5f, 1.25f, 0.5f), m_.awning[i]);
    }

    void pave() {
        // Roadway: patches of cobbles on a bed of mortar.
        const float width = kRoad, length = 4;
        int patches[3];
        for (std::uint32_t i = 0; i < 3; ++i)
            patches[i] = part(make_cobbles(width, length, 40 + 5 * i), m_.cobble);
        int count = 0;
        for (float z = kFar; z < kNear - 0.1f; z += length)
            for (float x : {-kRoad, 0.0f}) put(patches[count++ % 3], at(x, 0, z));
        Triangles bed, pavement;
        add_panel(bed, {-kRoad, -0.022f, kNear}, {2 * kRoad, 0, 0}, {0, 0, kFar - kNear}, 8, 60);
        put(part(bed, m_.slabs), glm::mat4(1));
        for (float side : {-1.0f, 1.0f}) {
            const float low = std::min(side * kRoad, side * (kFront + 3)),
                        high = std::max(side * kRoad, side * (kFront + 3));
            add_panel(pavement, {low, kKerb, kNear}, {high - low, 0, 0}, {0, 0, kFar - kNear}, 6, 60);
            // Kerb stones.
            for (float z = kFar; z < kNear; z += 1.0f)
                add_box(pavement, {side * kRoad - 0.12f, -0.1f, z + 0.01f},
                        {side * kRoad + 0.12f, kKerb + 0.015f, z + 0.99f});
        }
        put(part(pavement, m_.slabs), glm::mat4(1));
    }

    void add_house(int house, float side, float from) {
        const int key = 2 * house + (side > 0 ? 1 : 0);
        const int floors = 2 + static_cast<int>(chance(key, 0, 0) * 2.5f);
        const float width = 3 * kBay, top = kGround + static_cast<float>(floors) * kFloor + 0.4f;
        // The house's own frame: x along its front, z towards the street.
        const float turn = -side * std::numbers::pi_v<float> / 2;
        const glm::mat4 house_at = at(side * kFront, 0, from + width / 2, turn);
        const PaintedMaterial& skin = key % 4 == 3 ? m_.brick : m_.plaster[key % 3];

        // Upper wall, sides, roof, pillars of the ground floor.
        Triangles wall, trim;
        add_panel(wall, {-width / 2, kGround, 0}, {width, 0, 0}, {0, top - kGround, 0}, 10, 10);
        add_panel(wall, {width / 2, 0, 0}, {0, 0, -6}, {0, top, 0}, 4, 6);
        add_panel(wall, {-width / 2, 0, -6}, {0, 0, 6}, {0, top, 0}, 4, 6);
        add_panel(wall, {-width / 2, top, 0.3f}, {width, 0, 0}, {0, 2.2f, -4}, 4, 4);
        for (int i = 0; i <= 3; ++i) {
            const float x = -width / 2 + kBay * static_cast<float>(i);
            add_box(trim, {x - 0.28f, kKerb, -0.5f}, {x + 0.28f, kGround - 0.5f, 0.12f});
            add_box(trim, {x - 0.34f, kKerb, -0.5f}, {x + 0.34f, kKerb + 0.35f, 0.18f});
            add_box(trim, {x - 0.36f, kGround - 0.68f, -0.5f}, {x + 0.36f, kGround - 0.5f, 0.2f});
        }
        const std::vector<glm::vec2> cornice{{0, 0},       {0.08f, 0.0f},  {0.08f, 0.1f},  {0.2f, 0.22f},
                                             {0.2f, 0.3f}, {0.28f, 0.34f}, {0.28f, 0.42f}, {0, 0.42f}};
        Triangles moulding;
        add_moulding(moulding, cornice, width, 24);
        const glm::mat4 along_front = glm::rotate(glm::translate(glm::mat4(1), {width / 2, 0, 0}),
                                                  -std::numbers::pi_v<float> / 2, {0, 1, 0});
        for (float y : {kGround - 0.5f, top - 0.1f})
            add_transformed(trim, moulding, glm::translate(glm::mat4(1), {0, y, 0}) * along_front);
        for (int i = 0; i < 30; ++i) {
            const float x = -width / 2 + 0.26f * (static_cast<float>(i) + 0.5f);
            add_box(trim, {x - 0.06f, top - 0.28f, 0}, {x + 0.06f, top - 0.1f, 0.16f});
        }
        put(part(wall, skin), house_at);
        put(part(trim, m_.stone), house_at);

        for (int bay = 0; bay < 3; ++bay) {
            const float x = kBay * static_cast<float>(bay - 1);
            for (int floor = 0; floor < floors; ++floor)
                add_window(key, bay, floor,
                           house_at * at(x, kGround + 0.75f + kFloor * static_cast<float>(floor), 0));
            if (bay == key % 3)
                add_door(house_at * at(x, 0, 0));
            else
                add_shop(key, bay, house_at * at(x, 0, 0));
        }
        if (chance(key, 5, 3) > 0.35f) add_cafe(key, side, from);
    }

    void add_window(int key, int bay, int floor, const glm::mat4& where) {
        const int id = 10 * bay + floor;
        put(frame_, where);
        const float light = chance(key, id, 1);
        put(light < 0.30f ? lit_pane_[0] : light < 0.45f ? lit_pane_[1] : dark_pane_, where);
        if (chance(key, bay / 3, 2) > 0.3f) {
            const float open = light < 0.45f ? 0.15f : 0.5f + chance(key, id, 4);
            put(shutter_, where * at(0.68f, 0, 0.09f, -0.25f * open));
            put(shutter_, where * at(-0.68f, 0, 0.09f, 0.25f * open) * at(-0.56f, 0, 0));
        }
        if (floor == 0 && (bay + key) % 2 == 0) {
            put(balcony_, where * at(0, -0.6f, 0));
            put(rail_, where * at(0, -0.6f, 0));
        } else if (chance(key, id, 5) > 0.35f) {
            put(flower_box_, where * at(0, -0.02f, 0));
            put(flowers_, where * at(0, 0.2f, 0.16f));
        }
    }

    void add_door(const glm::mat4& where) {
        Triangles door, surround;
        add_box(door, {-0.62f, kKerb, -0.2f}, {0.62f, 2.6f, -0.12f});
        for (int i = 0; i < 2; ++i)
            for (int k = 0; k < 4; ++k) {
                const float x = -0.54f + 0.58f * static_cast<float>(i),
                            y = 0.3f + 0.56f * static_cast<float>(k);
                add_box(door, {x, y, -0.12f}, {x + 0.5f, y + 0.46f, -0.07f});
            }
        add_box(surround, {-1.02f, kKerb, -0.35f}, {-0.62f, kGround - 0.5f, 0});
        add_box(surround, {0.62f, kKerb, -0.35f}, {1.02f, kGround - 0.5f, 0});
        add_box(surround, {-0.62f, 2.6f, -0.35f}, {0.62f, kGround - 0.5f, 0});
        put(part(door, m_.wood), where);
        put(part(surround, m_.stone), where);
        put(bulb_, where * at(0, 2.95f, 0.22f));
        add_lamp(where * glm::vec4(0, 2.95f, 0.3f, 1), {0, -1, 0}, glm::vec3(3.2f, 2.1f, 1.0f), 5, 1.35f);
    }

    void add_shop(int key, int bay, const glm::mat4& where) {
        // A room behind the pane: shelves at the back, a lit ceiling, boards in front.
        Triangles room, shelves, boards, pane, sign;
        const float w = kBay / 2 - 0.30f, h = kGround - 0.5f;
        add_panel(room, {-w, kKerb, 0}, {2 * w, 0, 0}, {0, 0, -2.4f}, 2, 2);
        add_panel(room, {-w, h, -2.4f}, {2 * w, 0, 0}, {0, 0, 2.4f}, 2, 2);
        add_panel(shelves, {-w, kKerb, 0}, {0, 0, -2.4f}, {0, h - kKerb, 0}, 2, 2);
        add_panel(shelves, {w, kKerb, -2.4f}, {0, 0, 2.4f}, {0, h - kKerb, 0}, 2, 2);
        add_panel(shelves, {-w, kKerb, -2.4f}, {2 * w, 0, 0}, {0, h - kKerb, 0}, 2, 2);
        add_panel(shelves, {-0.6f * w, kKerb, -1.3f}, {1.2f * w, 0, 0}, {0, 1.0f, 0}, 2, 2);
        add_box(boards, {-w, kKerb, -0.1f}, {w, 0.55f, 0});
        for (float x : {-w, -0.03f, w - 0.06f})
            add_box(boards, {x, 0.55f, -0.06f}, {x + 0.06f, h - 0.55f, 0});
        add_box(boards, {-w, h - 0.62f, -0.08f}, {w, h - 0.5f, 0.02f});
        add_box(sign, {-w, h - 0.5f, -0.05f}, {w, h, 0.06f});
        add_panel(pane, {-w, 0.55f, -0.03f}, {2 * w, 0, 0}, {0, h - 1.15f, 0});
        put(part(room, m_.plaster[(key + bay) % 3]), where);
        put(part(shelves, m_.goods), where);
        put(part(boards, m_.wood), where);
        put(part(sign, m_.iron), where);
        put(part(pane, m_.glass), where);
        put(awning_[static_cast<std::size_t>((key + bay) % 2)], where * at(0, h - 0.12f, 0.08f));
        const bool warm = chance(key, bay, 7) < 0.6f;
        put(small_bulb_, where * at(0, h - 0.12f, -0.8f));
        add_lamp(where * glm::vec4(0, h - 0.25f, -0.8f, 1), glm::vec3(where * glm::vec4(0, -0.75f, 0.65f, 0)),
                 (warm ? glm::vec3(5.0f, 3.1f, 1.4f) : glm::vec3(4.0f, 3.7f, 3.1f)) * 1.4f, 6, 1.45f);
    }

    void add_cafe(int key, float side, float from) {
        for (int i = 0; i < 3; ++i) {
            const float z = from + 1.3f + 2.4f * static_cast<float>(i),
                        x = side * (kFront - 1.35f + 0.15f * chance(key, i, 11));
            const glm::mat4 table = at(x, kKerb, z, 2 * chance(key, i, 12));
            put(table_, table);
            put(chair_, table * at(0, 0, 0.62f, std::numbers::pi_v<float>));
            put(chair_, table * at(0, 0, -0.6f, 0.3f));
            put(bottle_, table * at(0.08f, 0.73f, 0.05f));
            put(wine_glass_, table * at(-0.12f, 0.73f, 0.12f));
            put(wine_glass_, table * at(0.02f, 0.73f, -0.17f));
            put(small_bulb_, table * at(-0.05f, 0.78f, -0.02f));
        }
        for (float dz : {0.1f, 7.6f}) {
            put(tub_, at(side * (kFront - 1.9f), kKerb, from + dz));
            put(bush_, at(side * (kFront - 1.9f), kKerb + 0.82f, from + dz));
        }
    }

    void close_the_far_end() {
        // A church front closes the view.
        Triangles front, lit;
        add_panel(front, {-9, 0, kFar - 2}, {18, 0, 0}, {0, 17, 0}, 12, 12);
        for (int i = -2; i <= 2; ++i) {
            const float x = 3.0f * static_cast<float>(i);
            add_box(front, {x - 0.4f, 0, kFar - 2}, {x + 0.4f, 16, kFar - 1.4f});
            if (i == 2) continue;
            add_panel(lit, {x + 0.9f, 5, kFar - 1.95f}, {1.2f, 0, 0}, {0, 6.5f, 0});
        }
        for (std::size_t i = 0; i < lit.vertices.size(); ++i)
            lit.vertices[i].uv = {static_cast<float>(i % 4 % 2), i % 4 < 2 ? 2.0f : 0.0f};
        put(part(front, m_.stone), glm::mat4(1));
        put(part(lit, m_.lit_window[0]), glm::mat4(1));
    }

    void lamps_and_trees() {
        for (int i = 0; i < 6; ++i) {
            for (float side : {-1.0f, 1.0f}) {
                const float z = kNear - 5.5f - 7.6f * static_cast<float>(i) - (side > 0 ? 3.8f : 0);
                const glm::mat4 post = at(side * (kRoad + 0.45f), kKerb, z);
                put(lamp_, post);
                put(panes_, post);
                put(bulb_, post * at(0, 3.62f, 0));
                add_lamp(post * glm::vec4(0, 3.62f, 0, 1), {0, -1, 0}, glm::vec3(15, 10.8f, 6.2f), 10, 1.5f);
                scene_.lights.back().casts_shadow = true;
                if ((i + (side > 0 ? 1 : 0)) % 2 == 0 && i > 0) {
                    const glm::mat4 tree = at(side * (kRoad + 0.5f), kKerb, z - 2.6f, static_cast<float>(i));
                    put(trunk_, tree);
                    put(crown_, tree * at(0, 4.3f, 0));
                }
            }
        }
    }

    void string_lights() {
        for (int line = 0; line < 8; ++line) {
            const float z = kNear - 7 - 5.2f * static_cast<float>(line),
                        slope = 0.8f * (chance(line, 0, 20) - 0.5f);
            const auto cable = [=](float t) {
                const float x = (2 * t - 1) * kFront;
                return glm::vec3(x, 4.6f + 0.9f * (2 * t - 1) * (2 * t - 1), z + slope * x);
            };
            put(part(make_tube(cable, 0.01f, 40, 5), m_.iron), glm::mat4(1));
            for (int i = 1; i < 18; ++i) {
                const glm::vec3 p = cable(static_cast<float>(i) / 18) - glm::vec3(0, 0.05f, 0);
                put(small_bulb_, at(p.x, p.y, p.z));
            }
            add_lamp(glm::vec4(cable(0.5f) - glm::vec3(0, 0.1f, 0), 1), {0, -1, 0},
                     glm::vec3(3.0f, 1.8f, 0.7f), 7, 0);
        }
    }

    // A cone of 0 is a lamp that shines everywhere.
    void add_lamp(glm::vec4 position, glm::vec3 direction, glm::vec3 intensity, float range_m,
                  float cone_rad) {
        PunctualLight lamp;
        lamp.kind = cone_rad > 0 ? LightKind::spot : LightKind::point;
        lamp.position = glm::vec3(position);
        lamp.direction = glm::normalize(direction);
        lamp.intensity = intensity;
        lamp.range_m = range_m;
        lamp.outer_cone_rad = cone_rad > 0 ? cone_rad : 0.785398f;
        lamp.inner_cone_rad = 0.7f * lamp.outer_cone_rad;
        scene_.lights.push_back(lamp);
    }

    Scene& scene_;
    StreetMaterials m_;
    int frame_ = 0, lit_pane_[2] = {}, dark_pane_ = 0, shutter_ = 0, rail_ = 0, balcony_ = 0, flower_box_ = 0,
        flowers_ = 0, lamp_ = 0, panes_ = 0, bulb_ = 0, small_bulb_ = 0, chair_ = 0, table_ = 0, bottle_ = 0,
        wine_glass_ = 0, trunk_ = 0, crown_ = 0, bush_ = 0, tub_ = 0, awning_[2] = {};
};

}  // namespace

Scene make_street_scene() {
    Scene scene;
    scene.name = "street";
    Builder(scene).build();
    // The moon.
    scene.sun = Sun{glm::normalize(glm::vec3(0.45f, 0.75f, 0.35f)), glm::vec3(0.10f, 0.13f, 0.20f), true};
    scene.sky = Sky{{0.008f, 0.012f, 0.028f}, {0.035f, 0.035f, 0.05f}, {0.02f, 0.018f, 0.016f}};
    scene.exposure = 0.34f;
    scene.cameras.push_back(camera_looking({-0.9f, 1.65f, 15.2f}, {0.35f, 2.35f, -4}, 1.0f));
    scene.cameras.front().name = "middle of the street";
    scene.cameras.push_back(camera_looking({3.6f, 1.5f, 9.0f}, {-2.5f, 1.9f, -2}, 1.0f));
    scene.cameras.back().name = "pavement";
    scene.path = {{0, {-0.9f, 1.65f, 15.2f}, {0.35f, 2.35f, -4}},
                  {4, {0.9f, 1.7f, 9.5f}, {-1.5f, 2.4f, -8}},
                  {8, {1.6f, 1.75f, 3.0f}, {-3.0f, 2.2f, -9}},
                  {12, {-1.2f, 2.2f, -4.5f}, {1.0f, 3.4f, -24}}};
    return scene;
}

}  // namespace parafovea
