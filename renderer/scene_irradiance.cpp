// Gathers light at probes (after Greger et al. 1998, "The Irradiance Volume").
#include "renderer/scene_irradiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/all_processors.h"
#include "renderer/scene_lighting.h"
#include "renderer/scene_voxels.h"

namespace parafovea {
namespace {

constexpr int kVoxelsAlong = 128;
constexpr float kProbes = 9000;
constexpr int kRays = 192;
constexpr int kBounces = 3;
constexpr float kPi = std::numbers::pi_v<float>;

// Even directions over the sphere (a Fibonacci spiral).
std::vector<glm::vec3> directions() {
    std::vector<glm::vec3> all;
    const float golden = kPi * (3 - std::sqrt(5.0f));
    for (int i = 0; i < kRays; ++i) {
        const float y = 1 - 2 * (static_cast<float>(i) + 0.5f) / kRays;
        const float r = std::sqrt(1 - y * y), angle = golden * static_cast<float>(i);
        all.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
    }
    return all;
}

// What a probe sees along one ray.
struct Seen {
    glm::vec3 light{0};     // that needs no bounce: the sky, emission, first reflection of sun and lamps
    glm::vec3 albedo{0};    // of what is hit; zero for the sky
    glm::vec3 position{0};  // just in front of what is hit
    glm::vec3 normal{0};
};

class Baker {
  public:
    explicit Baker(const Scene& scene) : scene_(scene), voxels_(scene, kVoxelsAlong), rays_(directions()) {
        const Bounds inside = world_bounds(scene);
        const glm::vec3 extent = glm::max(inside.high - inside.low, glm::vec3(1e-3f));
        const float spacing = std::max(std::cbrt(extent.x * extent.y * extent.z / kProbes), 0.05f);
        volume_.box = inside;
        volume_.size = glm::clamp(glm::ivec3(glm::round(extent / spacing)), glm::ivec3(1), glm::ivec3(128));
        cell_ = extent / glm::vec3(volume_.size);
        const auto probes = static_cast<std::size_t>(count());
        volume_.texels.assign(3 * probes, glm::vec4(0));
        seen_.resize(probes * kRays);
        good_.assign(probes, 0);
    }

    IrradianceVolume bake() {
        on_all_processors(count(), [&](int i) { look_around(i); });
        gather(false);
        for (int bounce = 1; bounce < kBounces; ++bounce) gather(true);
        for (int axis = 0; axis < 3; ++axis) soften(axis);
        return std::move(volume_);
    }

  private:
    int count() const { return volume_.size.x * volume_.size.y * volume_.size.z; }

    glm::vec3 position_of(int probe) const {
        const glm::ivec3 c{probe % volume_.size.x, probe / volume_.size.x % volume_.size.y,
                           probe / (volume_.size.x * volume_.size.y)};
        return volume_.box.low + (glm::vec3(c) + 0.5f) * cell_;
    }

    glm::vec3 first_light(glm::vec3 position, glm::vec3 normal, const VoxelSurface& surface) const {
        glm::vec3 light = surface.emission;
        if (scene_.sun) {
            const glm::vec3 to_sun = glm::normalize(scene_.sun->direction);
            const float cosine = glm::dot(normal, to_sun);
            if (cosine > 0 && voxels_.trace(position, to_sun).surface < 0)
                light += surface.albedo * scene_.sun->irradiance * (cosine / kPi);
        }
        for (const PunctualLight& lamp : scene_.lights) {
            const glm::vec3 to_lamp = lamp.position - position;
            const float distance = std::max(glm::length(to_lamp), 0.05f);
            const glm::vec3 direction = to_lamp / distance;
            const float cosine = glm::dot(normal, direction);
            if (cosine <= 0 || (lamp.range_m > 0 && distance > lamp.range_m)) continue;
            if (lamp.kind == LightKind::spot &&
                glm::dot(-direction, lamp.direction) < std::cos(lamp.outer_cone_rad))
                continue;
            const SceneVoxels::Hit hit = voxels_.trace(position, direction);
            // The lamp's own fitting does not count.
            if (hit.surface >= 0 && hit.distance_m < distance - 2.5f * voxels_.cell_m()) continue;
            light += surface.albedo * lamp.intensity * (cosine / (kPi * distance * distance));
        }
        return light;
    }

    void look_around(int probe) {
        const glm::vec3 from = position_of(probe);
        int from_behind = 0;
        for (int i = 0; i < kRays; ++i) {
            Seen& seen = seen_[static_cast<std::size_t>(probe) * kRays + static_cast<std::size_t>(i)];
            const glm::vec3 direction = rays_[static_cast<std::size_t>(i)];
            const SceneVoxels::Hit hit = voxels_.trace(from, direction);
            if (hit.surface < 0) {
                seen.light = sky_radiance(scene_.sky, direction);
                continue;
            }
            const VoxelSurface& surface = voxels_.surface(hit.surface);
            const float clarity = glm::length(surface.normal);
            const float towards = glm::dot(surface.normal, direction);
            from_behind += clarity > 0.6f && towards > 0.3f;
            // Cells that hold surfaces of many directions face whoever looks.
            seen.normal =
                clarity > 0.3f ? surface.normal / clarity * (towards > 0 ? -1.0f : 1.0f) : -direction;
            seen.position = from + direction * std::max(hit.distance_m - 0.3f * voxels_.cell_m(), 0.0f) +
                            seen.normal * (0.6f * voxels_.cell_m());
            seen.albedo = surface.albedo;
            seen.light = first_light(seen.position, seen.normal, surface);
        }
        good_[static_cast<std::size_t>(probe)] = !voxels_.filled(from) && from_behind < kRays * 3 / 10;
    }

    // Irradiance / pi at a point, from the volume as it stands.
    glm::vec3 sampled(glm::vec3 position, glm::vec3 normal) const {
        const glm::vec3 p = glm::clamp((position - volume_.box.low) / cell_ - 0.5f, glm::vec3(0),
                                       glm::vec3(volume_.size - 1));
        const glm::ivec3 low{p}, high = glm::min(low + 1, volume_.size - 1);
        const glm::vec3 t = p - glm::vec3(low);
        const glm::vec4 basis{1, normal.y, normal.z, normal.x};
        glm::vec3 sum{0};
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 c{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                               corner & 4 ? high.z : low.z};
            const float weight =
                (corner & 1 ? t.x : 1 - t.x) * (corner & 2 ? t.y : 1 - t.y) * (corner & 4 ? t.z : 1 - t.z);
            for (int color = 0; color < 3; ++color)
                sum[color] += weight * glm::dot(volume_.at(color, c.x, c.y, c.z), basis);
        }
        return glm::max(sum, glm::vec3(0));
    }

    void gather(bool with_bounce) {
        std::vector<glm::vec4> next(volume_.texels.size(), glm::vec4(0));
        const auto probes = static_cast<std::size_t>(count());
        on_all_processors(count(), [&](int probe) {
            if (!good_[static_cast<std::size_t>(probe)]) return;
            glm::vec4 sums[3] = {glm::vec4(0), glm::vec4(0), glm::vec4(0)};
            for (int i = 0; i < kRays; ++i) {
                const Seen& seen =
                    seen_[static_cast<std::size_t>(probe) * kRays + static_cast<std::size_t>(i)];
                glm::vec3 light = seen.light;
                if (with_bounce && seen.albedo != glm::vec3(0))
                    light += seen.albedo * sampled(seen.position, seen.normal);
                const glm::vec3 d = rays_[static_cast<std::size_t>(i)];
                // Over the sphere: Y00^2 4 pi / N = 1 / N; Y1m^2 (2 / 3) 4 pi / N = 2 / N times the
                // direction.
                const glm::vec4 weights = glm::vec4(1, 2 * d.y, 2 * d.z, 2 * d.x) * (1.0f / kRays);
                for (int color = 0; color < 3; ++color) sums[color] += light[color] * weights;
            }
            for (std::size_t color = 0; color < 3; ++color)
                next[color * probes + static_cast<std::size_t>(probe)] = sums[color];
        });
        volume_.texels = std::move(next);
        fill_bad_probes();
    }

    // Averages each good probe with its good neighbours along an axis, 1 : 2 : 1. A small window is met by
    // few rays, and by different ones from probe to probe.
    void soften(int axis) {
        const std::vector<glm::vec4> before = volume_.texels;
        const auto probes = static_cast<std::size_t>(count());
        const glm::ivec3 n = volume_.size;
        const int stride = axis == 0 ? 1 : axis == 1 ? n.x : n.x * n.y;
        for (int probe = 0; probe < count(); ++probe) {
            if (!good_[static_cast<std::size_t>(probe)]) continue;
            const int along = probe / stride % n[axis];
            for (std::size_t color = 0; color < 3; ++color) {
                const std::size_t own = color * probes + static_cast<std::size_t>(probe);
                glm::vec4 sum = 2.0f * before[own];
                float weight = 2;
                for (int side : {-1, 1}) {
                    const int other = probe + side * stride;
                    if (along + side < 0 || along + side >= n[axis] ||
                        !good_[static_cast<std::size_t>(other)])
                        continue;
                    sum += before[color * probes + static_cast<std::size_t>(other)];
                    ++weight;
                }
                volume_.texels[own] = sum / weight;
            }
        }
        fill_bad_probes();
    }

    // Probes inside walls take the mean of the good ones around them, ring after ring.
    void fill_bad_probes() {
        std::vector<char> good = good_;
        const glm::ivec3 n = volume_.size;
        const auto probes = static_cast<std::size_t>(count());
        for (int ring = 0; ring < 4; ++ring) {
            const std::vector<char> before = good;
            for (int probe = 0; probe < count(); ++probe) {
                if (before[static_cast<std::size_t>(probe)]) continue;
                const glm::ivec3 c{probe % n.x, probe / n.x % n.y, probe / (n.x * n.y)};
                glm::vec4 sums[3] = {glm::vec4(0), glm::vec4(0), glm::vec4(0)};
                float found = 0;
                for (int k = 0; k < 27; ++k) {
                    const glm::ivec3 o = c + glm::ivec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
                    if (glm::any(glm::lessThan(o, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(o, n)))
                        continue;
                    const int other = (o.z * n.y + o.y) * n.x + o.x;
                    if (!before[static_cast<std::size_t>(other)]) continue;
                    for (int color = 0; color < 3; ++color) sums[color] += volume_.at(color, o.x, o.y, o.z);
                    ++found;
                }
                if (found == 0) continue;
                for (std::size_t color = 0; color < 3; ++color)
                    volume_.texels[color * probes + static_cast<std::size_t>(probe)] = sums[color] / found;
                good[static_cast<std::size_t>(probe)] = 1;
            }
        }
    }

    const Scene& scene_;
    SceneVoxels voxels_;
    std::vector<glm::vec3> rays_;
    IrradianceVolume volume_;
    glm::vec3 cell_{1};
    std::vector<Seen> seen_;
    std::vector<char> good_;
};

}  // namespace

IrradianceVolume bake_irradiance(const Scene& scene) {
    return Baker(scene).bake();
}

}  // namespace parafovea
