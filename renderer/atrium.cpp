// Puts the columned hall together. The nave runs along z from -14 to 14, 8 m wide; aisles of 4 m lie to
// either side.
#include "renderer/atrium.h"

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "renderer/atrium_materials.h"
#include "renderer/atrium_parts.h"

namespace parafovea {
namespace {

constexpr int kBays = 8;
constexpr float kBay_m = 3.5f;
constexpr float kHalfLength = kBays * kBay_m / 2;
constexpr float kNave = 4.0f;   // x of the arcades
constexpr float kAisle = 8.0f;  // x of the outer walls
constexpr float kWall = 0.5f;   // thickness of the arcades
constexpr float kLowerColumn = 3.1f, kLowerRise = 2.0f, kUpperFloor = 5.5f;
constexpr float kUpperColumn = 2.0f, kUpperRise = 1.6f, kTop = 9.5f;

glm::mat4 at(float x, float y, float z, float turn_rad = 0) {
    return glm::rotate(glm::translate(glm::mat4(1), {x, y, z}), turn_rad, {0, 1, 0});
}

class Builder {
  public:
    explicit Builder(Scene& scene) : scene_(scene), m_(add_atrium_materials(scene)) {}

    void build() {
        floors_and_walls();
        for (float side : {-1.0f, 1.0f}) arcades(side);
        ends();
        furnish();
    }

  private:
    void place(const Triangles& mesh, const PaintedMaterial& paint, std::initializer_list<glm::mat4> where) {
        place(mesh, paint, std::vector<glm::mat4>(where));
    }
    void place(const Triangles& mesh, const PaintedMaterial& paint, const std::vector<glm::mat4>& where) {
        const int number = append_painted(scene_, mesh, paint);
        for (const glm::mat4& matrix : where) scene_.instances.push_back({number, matrix});
    }

    void floors_and_walls() {
        const float length = 2 * kHalfLength;
        Triangles floor;
        add_panel(floor, {-kAisle, 0, kHalfLength}, {2 * kAisle, 0, 0}, {0, 0, -length}, 20, 35);
        place(floor, m_.paving, {glm::mat4(1)});

        // Outer walls with pilasters, and the timber ceilings of the aisles below and above.
        Triangles walls, pilasters, timber;
        for (float side : {-1.0f, 1.0f}) {
            add_panel(walls, {side * kAisle, 0, -side * kHalfLength}, {0, 0, side * length}, {0, kTop, 0}, 35,
                      12);
            // The wall's outside: light must not slip in along its foot.
            const float shell = side * kAisle + side * 0.35f;
            add_box(pilasters, {shell - 0.3f, -0.4f, -kHalfLength - 0.5f},
                    {shell + 0.3f, kTop + 0.3f, kHalfLength + 0.5f});
            for (int i = 0; i <= kBays; ++i) {
                const float z = -kHalfLength + kBay_m * static_cast<float>(i);
                add_box(pilasters, {side * kAisle - 0.2f, 0, z - 0.25f},
                        {side * kAisle + 0.2f, kTop, z + 0.25f});
            }
            for (float y : {kUpperFloor - 0.12f, kTop - 0.12f}) {
                const float inner = side * (kNave - kWall / 2), outer = side * kAisle;
                const float low = std::min(inner, outer), high = std::max(inner, outer);
                add_panel(timber, {low, y, -kHalfLength}, {high - low, 0, 0}, {0, 0, length}, 4, 28);
                for (int i = 0; i < kBays * 4; ++i) {
                    const float z = -kHalfLength + kBay_m * (static_cast<float>(i) + 0.5f) / 4;
                    add_box(timber, {low, y - 0.16f, z - 0.08f}, {high, y + 0.02f, z + 0.08f});
                }
            }
            Triangles gallery;
            const float inner = side * (kNave - kWall / 2), outer = side * kAisle;
            add_panel(gallery, {std::min(inner, outer), kUpperFloor, kHalfLength},
                      {std::abs(outer - inner), 0, 0}, {0, 0, -length}, 6, 35);
            place(gallery, m_.paving, {glm::mat4(1)});
            // The roof keeps the sun out of the gallery.
            add_panel(timber, {std::min(inner, outer), kTop + 0.3f, kHalfLength},
                      {std::abs(outer - inner), 0, 0}, {0, 0, -length}, 4, 28);
        }
        place(walls, m_.brick, {glm::mat4(1)});
        place(pilasters, m_.stone, {glm::mat4(1)});
        place(timber, m_.wood, {glm::mat4(1)});
    }

    void arcades(float side) {
        // The bays' fronts look along +z; a quarter turn points them into the nave.
        const float turn = -side * std::numbers::pi_v<float> / 2;
        const float x = side * kNave;
        std::vector<glm::mat4> lower_bays, upper_bays, lower_columns, upper_columns, balusters;
        for (int i = 0; i < kBays; ++i) {
            const float z = -kHalfLength + kBay_m * (static_cast<float>(i) + 0.5f);
            lower_bays.push_back(at(x, kLowerColumn, z, turn));
            upper_bays.push_back(at(x, kUpperFloor + kUpperColumn, z, turn));
            for (int k = 0; k < 8; ++k)
                balusters.push_back(at(x, kUpperFloor + 0.02f, z + (static_cast<float>(k) - 3.5f) * 0.36f));
        }
        for (int i = 0; i <= kBays; ++i) {
            const float z = -kHalfLength + kBay_m * static_cast<float>(i);
            lower_columns.push_back(at(x, 0, z));
            upper_columns.push_back(at(x, kUpperFloor, z));
        }
        const ArchBay lower = make_arch_bay(kBay_m, 1.36f, kLowerRise, kWall);
        const ArchBay upper = make_arch_bay(kBay_m, 1.36f, kUpperRise, kWall);
        place(lower.wall, m_.brick, lower_bays);
        place(lower.trim, m_.stone, lower_bays);
        place(upper.wall, m_.brick, upper_bays);
        place(upper.trim, m_.stone, upper_bays);
        place(make_column(kLowerColumn, 0.27f, 20), m_.stone, lower_columns);
        place(make_column(kUpperColumn, 0.19f, 16), m_.stone, upper_columns);
        place(make_baluster(), m_.stone, balusters);

        // Friezes and cornices along the whole length, with a row of dentils under each.
        const float length = 2 * kHalfLength;
        const std::vector<glm::vec2> cornice{{0, 0},         {0.06f, 0},    {0.06f, 0.08f}, {0.14f, 0.16f},
                                             {0.14f, 0.22f}, {0.2f, 0.24f}, {0.2f, 0.3f},   {0, 0.3f}};
        const std::vector<glm::vec2> band{{0, 0}, {0.03f, 0}, {0.03f, 0.4f}, {0, 0.4f}};
        const glm::mat4 into_nave = side < 0 ? at(x + kWall / 2, 0, -kHalfLength)
                                             : at(x - kWall / 2, 0, kHalfLength, std::numbers::pi_v<float>);
        Triangles carved, moulded;
        add_moulding(carved, band, length, 56);
        add_moulding(moulded, cornice, length, 56);
        for (int i = 0; i < 112; ++i) {
            const float z = 0.125f + 0.25f * static_cast<float>(i);
            add_box(moulded, {0, -0.1f, z - 0.06f}, {0.08f, 0, z + 0.06f});
        }
        const glm::mat4 lower_band = glm::translate(into_nave, {0, kUpperFloor - 0.4f, 0});
        const glm::mat4 upper_band = glm::translate(into_nave, {0, kTop - 0.4f, 0});
        place(carved, m_.frieze, {lower_band, upper_band});
        place(moulded, m_.stone,
              {glm::translate(into_nave, {0, kUpperFloor - 0.02f, 0}),
               glm::translate(into_nave, {0, kTop, 0})});
        Triangles rail, wall_tops;
        add_box(rail, {x - 0.1f, kUpperFloor + 0.82f, -kHalfLength},
                {x + 0.1f, kUpperFloor + 0.94f, kHalfLength});
        add_box(wall_tops, {x - kWall / 2, kLowerColumn + kLowerRise, -kHalfLength},
                {x + kWall / 2, kUpperFloor, kHalfLength});
        add_box(wall_tops, {x - kWall / 2, kUpperFloor + kUpperColumn + kUpperRise, -kHalfLength},
                {x + kWall / 2, kTop + 0.3f, kHalfLength});
        place(rail, m_.stone, {glm::mat4(1)});
        place(wall_tops, m_.brick, {glm::mat4(1)});
    }

    void ends() {
        Triangles walls, trim, doors, carved;
        for (float side : {-1.0f, 1.0f}) {
            const float z = side * kHalfLength;
            add_panel(walls, {side * -kAisle, 0, z}, {side * 2 * kAisle, 0, 0}, {0, kTop + 0.3f, 0}, 20, 12);
        }
        // Panels face inwards: turn those that look out.
        for (SceneVertex& v : walls.vertices) v.normal.z = v.position.z > 0 ? -1.0f : 1.0f;
        for (std::size_t i = 0; i < walls.indices.size(); i += 3) {
            const SceneVertex &a = walls.vertices[walls.indices[i]],
                              &b = walls.vertices[walls.indices[i + 1]],
                              &c = walls.vertices[walls.indices[i + 2]];
            if (glm::dot(glm::cross(b.position - a.position, c.position - a.position), a.normal) < 0)
                std::swap(walls.indices[i + 1], walls.indices[i + 2]);
        }
        place(walls, m_.brick, {glm::mat4(1)});

        // A portal at each end: a door in a moulded arch between columns, a round window of tracery above.
        const ArchBay portal = make_arch_bay(3.9f, 1.5f, 2.2f, 0.5f);
        add_panel(doors, {-1.5f, 0, 0}, {3, 0, 0}, {0, 3.0f, 0}, 6, 6);
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 4; ++k) {
                const float x0 = -1.4f + 0.47f * static_cast<float>(i),
                            y0 = 0.2f + 0.7f * static_cast<float>(k);
                add_box(doors, {x0, y0, 0}, {x0 + 0.4f, y0 + 0.6f, 0.05f});
            }
        add_surface(doors, 32, 4, [](float u, float v) {
            const float angle = std::numbers::pi_v<float> * (1 - u);
            const float r = 1.5f * v + 1e-3f;
            return SurfacePoint{{r * std::cos(angle), 3 + r * std::sin(angle), 0},
                                {r * std::cos(angle), -r * std::sin(angle)}};
        });
        add_box(carved, {-1.95f, 5.22f, -0.1f}, {1.95f, 5.62f, 0.3f});
        const glm::mat4 north = at(0, 0, -kHalfLength + 0.02f),
                        south = at(0, 0, kHalfLength - 0.02f, std::numbers::pi_v<float>);
        const glm::mat4 up = at(0, 3.0f, 0.2f);
        place(portal.wall, m_.stone, {north * up, south * up});
        place(portal.trim, m_.stone, {north * up, south * up});
        place(doors, m_.wood, {north, south});
        place(carved, m_.frieze, {north, south});
        place(make_column(3.0f, 0.2f, 16), m_.stone,
              {north * at(-1.74f, 0, 0.35f), north * at(1.74f, 0, 0.35f), south * at(-1.74f, 0, 0.35f),
               south * at(1.74f, 0, 0.35f)});
        // Tracery: rings and spokes.
        for (float radius : {0.35f, 0.75f, 1.15f})
            add_surface(trim, 48, 10, [radius](float u, float v) {
                const float a = 2 * std::numbers::pi_v<float> * u, b = 2 * std::numbers::pi_v<float> * v;
                const float r = radius + 0.07f * std::cos(b);
                return SurfacePoint{{r * std::cos(a), r * std::sin(a), 0.07f * std::sin(b)},
                                    {a * radius, 0.4f * v}};
            });
        for (int i = 0; i < 12; ++i) {
            Triangles spoke;
            add_box(spoke, {0.35f, -0.03f, -0.04f}, {1.15f, 0.03f, 0.04f});
            add_transformed(
                trim, spoke,
                glm::rotate(glm::mat4(1), std::numbers::pi_v<float> * static_cast<float>(i) / 6, {0, 0, 1}));
        }
        place(trim, m_.stone, {north * at(0, 7.4f, 0.05f), south * at(0, 7.4f, 0.05f)});
        Triangles glass;
        add_surface(glass, 48, 4, [](float u, float v) {
            const float a = 2 * std::numbers::pi_v<float> * (1 - u), r = 1.2f * v + 1e-3f;
            return SurfacePoint{{r * std::cos(a), r * std::sin(a), 0.0f}, {0.5f * u * 6, -v}};
        });
        place(glass, m_.glazed, {north * at(0, 7.4f, 0.02f), south * at(0, 7.4f, 0.02f)});
    }

    void furnish() {
        // Cloths hang in the upper arches of every other bay, long ones from the gallery rail between them.
        for (int i = 0; i < kBays; ++i) {
            const float z = -kHalfLength + kBay_m * (static_cast<float>(i) + 0.5f);
            const auto phase = static_cast<float>(i) * 0.37f;
            const bool long_one = i % 2 == 0;
            const Triangles cloth = make_hanging(long_one ? 1.7f : 2.3f, long_one ? 2.9f : 1.1f, phase);
            const float y = long_one ? kUpperFloor + 0.75f : kUpperFloor + 3.0f;
            const float turn = std::numbers::pi_v<float> / 2;
            place(cloth, m_.cloth[i % 3],
                  {at(-kNave + (long_one ? 0.42f : 0.0f), y, z, turn),
                   at(kNave - (long_one ? 0.42f : 0.0f), y, z, -turn)});
        }
        // Vases on pedestals along the arcades, large ones on the floor of the nave.
        std::vector<glm::mat4> pedestals, vases[3];
        for (int i = 0; i < kBays - 1; ++i) {
            const float z = -kHalfLength + kBay_m * static_cast<float>(i + 1);
            for (float side : {-1.0f, 1.0f}) {
                const float x = side * (kNave - 0.85f);
                if ((i + (side > 0 ? 1 : 0)) % 2 == 0) {
                    pedestals.push_back(at(x, 0, z));
                    vases[i % 3].push_back(at(x, 0.92f, z));
                } else {
                    vases[(i + 1) % 3].push_back(glm::scale(at(x, 0, z), glm::vec3(1.25f)));
                }
            }
        }
        place(make_pedestal(), m_.stone, pedestals);
        for (int shape = 0; shape < 3; ++shape)
            place(make_vase(shape), shape == 1 ? m_.bronze : m_.glazed, vases[shape]);
        std::vector<glm::mat4> lamps;
        for (int i = 0; i < kBays; ++i)
            for (float side : {-1.0f, 1.0f})
                lamps.push_back(at(side * (kNave + 1.9f), kUpperFloor - 0.2f,
                                   -kHalfLength + kBay_m * (static_cast<float>(i) + 0.5f)));
        place(make_hanging_lamp(1.3f), m_.bronze, lamps);
    }

    Scene& scene_;
    AtriumMaterials m_;
};

}  // namespace

Scene make_atrium_scene() {
    Scene scene;
    scene.name = "atrium";
    Builder(scene).build();
    scene.sun = Sun{glm::normalize(glm::vec3(0.36f, 0.86f, 0.22f)), glm::vec3(9.0f, 8.0f, 6.6f), true};
    scene.sky = Sky{{0.55f, 0.95f, 1.9f}, {1.6f, 1.75f, 1.9f}, {0.30f, 0.24f, 0.18f}};
    scene.exposure = 0.62f;
    scene.cameras.push_back(camera_looking({-1.1f, 1.75f, 12.2f}, {0.5f, 2.75f, -6}, 1.05f));
    scene.cameras.front().name = "nave";
    scene.cameras.push_back(camera_looking({-6.2f, 1.7f, 9.5f}, {3.0f, 2.3f, -4}, 1.05f));
    scene.cameras.back().name = "aisle";
    scene.path = {{0, {-1.1f, 1.75f, 12.2f}, {0.5f, 2.75f, -6}},
                  {4, {0.6f, 1.8f, 7.0f}, {-1.0f, 2.8f, -8}},
                  {8, {1.6f, 1.9f, 1.0f}, {-3.5f, 3.2f, -9}},
                  {12, {-0.8f, 2.2f, -5.0f}, {2.0f, 3.6f, -13}}};
    return scene;
}

}  // namespace parafovea
