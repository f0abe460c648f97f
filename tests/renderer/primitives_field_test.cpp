// The distances of the ray-marched scene: what sphere tracing relies on, at random points.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "devices/random.h"
#include "renderer/gpu_pipeline.h"
#include "shader_code/primitives_field_points.h"

namespace parafovea {
namespace {

struct Vec4 {
    float x, y, z, w;
};

struct Pair {
    Vec4 p, q;
    double apart_m() const { return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z); }
};

// Of one row of solids.
struct Found {
    float at_p, at_q;                 // distances
    float span_first, span_last;      // along the ray from q to p
    float bundle_first, bundle_last;  // along any ray of a bundle that holds it
};

constexpr int kRows = 3;

std::vector<Pair> random_pairs(int count) {
    Random random(2018);
    const auto between = [&](double low, double high) {
        return static_cast<float>(low + random.uniform() * (high - low));
    };
    std::vector<Pair> pairs;
    for (int i = 0; i < count; ++i) {
        const Vec4 q{between(-7, 7), between(0, 2.5), between(-5, 4), between(-0.05, 0.05)};
        pairs.push_back(
            {{q.x + between(-1, 1), q.y + between(-1, 1), q.z + between(-1, 1), between(-0.05, 0.05)}, q});
    }
    return pairs;
}

std::vector<Found> on_device(const std::vector<Pair>& pairs) {
    Gpu gpu({.validation = true});
    GpuBuffer in(gpu, pairs.size() * sizeof(Pair), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::upload);
    GpuBuffer out(gpu, pairs.size() * kRows * sizeof(Found), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                  BufferPlace::readback);
    DescriptorSet set(gpu, {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
    const OwnedPipelineLayout layout = make_pipeline_layout(gpu, {set.layout()});
    const OwnedPipeline pipeline =
        make_compute_pipeline(gpu, shader_code::primitives_field_points, layout.get());
    set.set_buffer(0, in);
    set.set_buffer(1, out);
    in.write(std::span<const Pair>(pairs));
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        const VkDescriptorSet bound = set.get();
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout.get(), 0, 1, &bound, 0,
                                nullptr);
        vkCmdDispatch(commands, static_cast<std::uint32_t>(pairs.size() + 63) / 64, 1, 1);
        memory_barrier(commands, kUseComputeStorage, kUseHostRead);
    });
    std::vector<Found> found(pairs.size() * kRows);
    std::memcpy(found.data(), out.mapped(), found.size() * sizeof(Found));
    EXPECT_TRUE(gpu.validation_messages().empty());
    return found;
}

TEST(PrimitivesField, SolidsLieInTheirBoundsAndNoStepGoesThroughThem) {
    const std::vector<Pair> pairs = random_pairs(300000);
    const std::vector<Found> found = on_device(pairs);
    std::size_t inside = 0, out_of_bounds = 0, through = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Found& f = found[i];
        if (f.at_q > 0) continue;
        ++inside;
        out_of_bounds += f.span_first > 0 || f.span_last <= 0;
        // From p the solid's point q is no nearer than the distance that is told.
        const double apart_m = pairs[i / kRows].apart_m();
        through += f.at_p > 1.0001 * apart_m + 1e-4;
    }
    EXPECT_GT(inside, pairs.size() / 30);
    EXPECT_EQ(out_of_bounds, 0U);
    EXPECT_EQ(through, 0U);
}

TEST(PrimitivesField, NoRayOfABundleMeetsASolidBeforeTheBundleBegins) {
    const std::vector<Pair> pairs = random_pairs(300000);
    const std::vector<Found> found = on_device(pairs);
    std::size_t met = 0, begun_late = 0, ended_early = 0, gained = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Found& f = found[i];
        if (f.at_p > 0) continue;
        ++met;
        const double apart_m = pairs[i / kRows].apart_m();
        begun_late += f.bundle_first > apart_m + 1e-4;
        ended_early += f.bundle_last < apart_m - 1e-4;
        gained += f.at_q > 0.2 && f.bundle_first > f.span_first + 0.1F;
    }
    EXPECT_GT(met, pairs.size() / 30);
    EXPECT_EQ(begun_late, 0U);
    EXPECT_EQ(ended_early, 0U);
    EXPECT_GT(gained, met / 20);
}

}  // namespace
}  // namespace parafovea
