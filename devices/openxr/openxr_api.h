// The OpenXR headers with the platform parts that are used: Vulkan, and the host's clock.
#pragma once

#include <vulkan/vulkan.h>

#include <ctime>

#ifndef XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_GRAPHICS_API_VULKAN
#endif
#ifndef XR_USE_TIMESPEC
#define XR_USE_TIMESPEC
#endif
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
