// What the OpenXR loader and a runtime tell each other at first: OpenXR loader specification, "Runtime
// interface negotiation". Debian's development package does not have it.
#pragma once

#include <openxr/openxr.h>

#include <cstddef>
#include <cstdint>

namespace parafovea::headset {

inline constexpr std::int32_t kLoaderInfo = 1;
inline constexpr std::int32_t kRuntimeRequest = 3;
inline constexpr std::uint32_t kInterfaceVersion = 1;

struct LoaderInfo {
    std::int32_t kind;
    std::uint32_t struct_version;
    std::size_t size;
    std::uint32_t min_interface_version;
    std::uint32_t max_interface_version;
    XrVersion min_api_version;
    XrVersion max_api_version;
};

struct RuntimeRequest {
    std::int32_t kind;
    std::uint32_t struct_version;
    std::size_t size;
    std::uint32_t interface_version;
    XrVersion api_version;
    PFN_xrGetInstanceProcAddr get_procedure;
};

}  // namespace parafovea::headset
