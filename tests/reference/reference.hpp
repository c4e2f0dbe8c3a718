#pragma once
// The plain walk that every other is measured against (walk.hpp), behind the interface of a copy of
// the kernel. It is no part of the library.

#include "kernel/query/variants.hpp"

namespace grelha {

/// Traces one ray and one primitive at a time, without SIMD and without floats. Of
/// the settings it heeds the mailbox alone. Its loops have no other functions than those two.
const Variant& reference_walk();

}  // namespace grelha
