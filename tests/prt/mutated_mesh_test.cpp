// SPDX-License-Identifier: Apache-2.0
// Damaged meshes are read or refused; they never crash, hang or take more memory than allowed.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "core/error.h"
#include "core/memory.h"
#include "prt/mesh_normals.h"
#include "prt/mesh_topology.h"
#include "tests/core/mutate.h"
#include "tests/core/scratch_directory.h"
#include "tests/prt/mesh_files.h"

namespace airlight {
namespace {

constexpr std::size_t kLimit = std::size_t{16} << 20;

/// Reads the bytes; whatever comes out keeps the promises of prt/mesh.h. True when it was read.
bool read_or_refuse(const std::string& bytes, const std::string& name) {
    MeshReadOptions options;
    options.max_memory = kLimit;
    options.nonfinite = NonfiniteVertex::zero;
    MeshReport report;
    Mesh mesh;
    try {
        mesh = parse_mesh(bytes, name, options, &report);
    } catch (const Error& error) {
        EXPECT_NE(error.what(), std::string());
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return false;
    }
    EXPECT_LE(mesh.bytes(), kLimit);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) {
        EXPECT_TRUE(std::fabs(p.x) <= kLargestCoordinate && std::fabs(p.y) <= kLargestCoordinate &&
                    std::fabs(p.z) <= kLargestCoordinate);
    }
    for (const glm::dvec3& n : mesh.normals) {
        EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1, 1e-12);
    }
    for (const glm::uvec3& t : mesh.triangles) {
        EXPECT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
        EXPECT_TRUE(t.x != t.y && t.y != t.z && t.z != t.x);
    }
    EXPECT_EQ(report.normals_from_file + report.normals_from_angles + report.normals_from_one_face +
                  report.normals_up,
              mesh.positions.size());
    mesh_topology(mesh);
    return true;
}

Mesh seed() {
    Mesh mesh = make_globe(3);
    mesh.positions.emplace_back(2, 2, 2);
    MeshReport ignored;
    compute_normals(mesh, {}, ignored);
    return mesh;
}

class MutatedMesh : public testing::TestWithParam<std::size_t> {
  protected:
    const NamedMesh file_ = in_all_formats(seed())[GetParam()];
};
INSTANTIATE_TEST_SUITE_P(Formats, MutatedMesh, testing::Range(std::size_t{0}, std::size_t{7}),
                         [](const auto& each) { return in_all_formats(seed())[each.param].name; });

TEST_P(MutatedMesh, CutAnywhereIsReadOrRefused) {
    int whole = 0;
    for (std::size_t size = 0; size <= file_.bytes.size(); ++size) {
        whole += read_or_refuse(file_.bytes.substr(0, size), file_.name);
    }
    EXPECT_GT(whole, 0);
    // OBJ says nowhere how long it is; of the others almost every cut is noticed.
    if (file_.name != "obj") {
        EXPECT_LT(whole, 20);
    }
}

TEST_P(MutatedMesh, WithFlippedBitsIsReadOrRefused) {
    for (std::size_t bit = 0; bit < 8 * std::min<std::size_t>(file_.bytes.size(), 400); ++bit) {
        std::string bytes = file_.bytes;
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
        read_or_refuse(bytes, file_.name);
    }
}

/// Numbers that do not fit, too, in every third.
std::string damage(const std::string& bytes, std::mt19937& random) {
    std::string damaged = mutate(bytes, random);
    if (random() % 3 == 0) {
        constexpr const char* kWords[] = {"9999999999", "-1", "nan", "1e999", " 0 ", "\n"};
        damaged.insert(random() % (damaged.size() + 1), kWords[random() % 6]);
    }
    return damaged;
}

TEST_P(MutatedMesh, DamagedAnyhowIsReadOrRefusedWithinMemory) {
    constexpr int kMutations = 3000;
    const std::size_t before = peak_memory();
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    int refused = 0;
    for (int i = 0; i < kMutations; ++i) {
        refused += !read_or_refuse(damage(file_.bytes, random), file_.name);
    }
    EXPECT_GT(refused, kMutations / 4);
    // A sanitizer's bookkeeping fits as well.
    EXPECT_LT(peak_memory(), before + 8 * kLimit);
}

TEST(MutatedMesh, TheCorpusIsReadOrRefused) {
    for (const char* format : {"obj", "ply", "stl", "off"}) {
        int files = 0, read = 0;
        for (const auto& entry : std::filesystem::directory_iterator(
                 std::string(AIRLIGHT_FUZZ_CORPUS) + "/" + format)) {
            ++files;
            read += read_or_refuse(read_bytes(entry.path().string()), "a." + std::string(format));
        }
        EXPECT_GT(files, 3) << format;
        EXPECT_GT(read, 0) << format;
    }
}

}  // namespace
}  // namespace airlight
