// SPDX-License-Identifier: Apache-2.0
// Keys: whether two bakes were asked for the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "prt/mesh.h"
#include "prt/prt_file.h"

namespace airlight {

/// Makes a key (XXH3 of 128 bits) of a sequence of values. What is added counts with its kind and
/// length, so "ab", "c" and "a", "bc" differ, and so do 1 and 1.0. The same on every machine. Not
/// meant to withstand forgery.
class PrtKeyHash {
  public:
    PrtKeyHash();
    ~PrtKeyHash();
    PrtKeyHash(PrtKeyHash&&) noexcept;
    PrtKeyHash& operator=(PrtKeyHash&&) noexcept;

    PrtKeyHash& add(std::string_view text);
    PrtKeyHash& add(double value);  ///< by its bits: -0 and 0 differ
    PrtKeyHash& add_integer(std::uint64_t value);
    PrtKeyHash& add(const PrtKey& key);
    PrtKeyHash& add(const Mesh& mesh);  ///< positions, normals and triangles, in their order

    PrtKey key() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// PrtKeyHash().add(mesh).key(): what PrtHeader::mesh holds.
PrtKey mesh_key(const Mesh& mesh);

}  // namespace airlight
