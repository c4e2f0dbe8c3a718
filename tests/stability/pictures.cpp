#include "tests/stability/pictures.hpp"

#include "tests/stability/picture_kinds.hpp"

namespace grelha::stability {

std::vector<PictureRow> picture_rows() {
  return {
      {"mirror shafts",
       "closed bodies of mirrors from inside, depth 50, sizes 1e-6 to 1e6",
       "no light gets in",
       mirror_shaft},
      {"total reflection",
       "inside glass balls beyond the critical angle, depth 50",
       "no light gets in",
       total_reflection},
      {"clear bodies",
       "nested, equal and touching balls, index below 1, in a white world",
       "white",
       white_furnace},
      {"glass ball",
       "rays up to the rim, index .8, 1.05, 1.5",
       "Snell's law in long double",
       glass_ball},
      {"lenses",
       "aperture 0 to larger than the scene, focus 1e-6 to 1e30; 0, infinite, NaN",
       "the pinhole's bits; white; refused or finite",
       lenses},
      {"light of size 0",
       "edges of 0, 1e-30, 1e-38",
       "the point light's picture",
       light_of_no_size},
      {"roughness 0", "0 and 1e-20", "the mirror's picture", roughness_of_nothing},
      {"discs of a tenth of a pixel",
       "--error, one disc in each sixteenth pixel",
       "each is seen",
       small_discs},
      {"correlated samples",
       "a penumbra across one pixel, 16 samples",
       "the mean over independent samples, 4 standard errors",
       correlated},
  };
}

}  // namespace grelha::stability
