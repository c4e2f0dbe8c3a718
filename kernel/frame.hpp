#pragma once

#include "kernel/camera.hpp"
#include "kernel/shading_view.hpp"

namespace grelha {

/// The frame of a sound camera. Its tangent comes from a series of our own: libm's last bit depends
/// on the machine.
FrameView make_frame(const Camera& camera);

}  // namespace grelha
