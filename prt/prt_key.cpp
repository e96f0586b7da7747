// SPDX-License-Identifier: Apache-2.0
#include "prt/prt_key.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <utility>

#include "prt/byte_order.h"
#include "prt/prt_checksum.h"

namespace airlight {
namespace {

// What kind of value follows.
enum : unsigned char { kText = 1, kReal, kInteger, kKey, kMesh };

// A block of numbers as bytes, for meshes.
class Bytes {
  public:
    explicit Bytes(XXH3_state_t* state) : state_(state) {}
    ~Bytes() { XXH3_128bits_update(state_, block_.data(), used_); }
    Bytes(const Bytes&) = delete;
    Bytes& operator=(const Bytes&) = delete;

    void put(std::uint64_t value, std::size_t size) {
        if (used_ + size > block_.size()) {
            XXH3_128bits_update(state_, block_.data(), used_);
            used_ = 0;
        }
        detail::store_unsigned(value, size, block_.data() + used_);
        used_ += size;
    }
    void put(const glm::dvec3& vector) {
        for (int i = 0; i < 3; ++i) put(detail::bits_of(vector[i]), 8);
    }

  private:
    XXH3_state_t* state_;
    std::array<char, 1 << 14> block_;
    std::size_t used_ = 0;
};

}  // namespace

struct PrtKeyHash::State {
    XXH3_state_t* hash = XXH3_createState();
    State() {
        if (hash == nullptr) throw std::bad_alloc();
        XXH3_128bits_reset(hash);
    }
    ~State() { XXH3_freeState(hash); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void begin(unsigned char kind, std::uint64_t size) {
        char bytes[9] = {static_cast<char>(kind)};
        detail::store_unsigned(size, 8, bytes + 1);
        XXH3_128bits_update(hash, bytes, sizeof bytes);
    }
};

PrtKeyHash::PrtKeyHash() : state_(std::make_unique<State>()) {}
PrtKeyHash::~PrtKeyHash() = default;
PrtKeyHash::PrtKeyHash(PrtKeyHash&&) noexcept = default;
PrtKeyHash& PrtKeyHash::operator=(PrtKeyHash&&) noexcept = default;

PrtKeyHash& PrtKeyHash::add(std::string_view text) {
    state_->begin(kText, text.size());
    XXH3_128bits_update(state_->hash, text.data(), text.size());
    return *this;
}

PrtKeyHash& PrtKeyHash::add(double value) {
    state_->begin(kReal, detail::bits_of(value));
    return *this;
}

PrtKeyHash& PrtKeyHash::add_integer(std::uint64_t value) {
    state_->begin(kInteger, value);
    return *this;
}

PrtKeyHash& PrtKeyHash::add(const PrtKey& key) {
    state_->begin(kKey, key.bytes.size());
    XXH3_128bits_update(state_->hash, key.bytes.data(), key.bytes.size());
    return *this;
}

PrtKeyHash& PrtKeyHash::add(const Mesh& mesh) {
    state_->begin(kMesh, mesh.positions.size());
    state_->begin(kMesh, mesh.normals.size());
    state_->begin(kMesh, mesh.triangles.size());
    Bytes bytes(state_->hash);
    for (const glm::dvec3& position : mesh.positions) bytes.put(position);
    for (const glm::dvec3& normal : mesh.normals) bytes.put(normal);
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i) bytes.put(triangle[i], 4);
    }
    return *this;
}

PrtKey PrtKeyHash::key() const {
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->hash));
    PrtKey key;
    static_assert(sizeof canonical.digest == sizeof key.bytes);
    std::copy(std::begin(canonical.digest), std::end(canonical.digest), key.bytes.begin());
    return key;
}

PrtKey mesh_key(const Mesh& mesh) {
    return PrtKeyHash().add(mesh).key();
}

std::uint64_t detail::checksum(const void* data, std::size_t bytes) {
    return XXH3_64bits(data, bytes);
}

}  // namespace airlight
