#pragma once
// The kinds of pictures with a known answer; each makes some of size x size pixels.

#include "tests/stability/pictures.hpp"

namespace grelha::stability {

PictureCounts mirror_shaft(int size);
PictureCounts total_reflection(int size);
PictureCounts white_furnace(int size);
PictureCounts glass_ball(int size);
PictureCounts lenses(int size);
PictureCounts light_of_no_size(int size);
PictureCounts roughness_of_nothing(int size);
PictureCounts small_discs(int size);
PictureCounts correlated(int size);

}  // namespace grelha::stability
