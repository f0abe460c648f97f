// Reads the small notations of the command line: WxH, X,Y, NAME=VALUE.
#pragma once

#include <string>
#include <utility>

#include "devices/geometry.h"
#include "renderer/methods/foveation_method.h"

namespace parafovea {

// "1280x720"; throws CLI::ValidationError otherwise.
SizePx parse_size(const std::string& text);

// "640,360.5", in pixels from the top left corner; throws CLI::ValidationError otherwise.
PointPx parse_point(const std::string& text);

// "1..28", both above 0 and in order; throws CLI::ValidationError otherwise.
std::pair<int, int> parse_range(const std::string& text);

// "inset=0.05" or "kernel=sine" into a method's numbers or words; throws CLI::ValidationError naming the
// option otherwise.
void add_setting(const std::string& option, const std::string& text, RenderMethod& method);

}  // namespace parafovea
