// FLIP: how different two pictures look when they are alternated in place, pixel by pixel, from 0 to 1.
//
// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A difference evaluator
// for alternating images", Proc. ACM on Computer Graphics and Interactive Techniques 3(2), 2020; written from
// its equations. It knows the distance of the viewer but not gaze.
#pragma once

#include <vector>

#include "analysis/visible_difference.h"

namespace parafovea {

// One value a pixel, rows from the top. Symmetric in the two pictures. Throws std::runtime_error where their
// sizes differ, are empty or longer than their bytes, or pixels_per_degree is not positive and finite.
std::vector<float> flip_map(RgbaView test, RgbaView reference, double pixels_per_degree);

// The mean of the map.
double flip_mean(const std::vector<float>& map);

}  // namespace parafovea
