// SPDX-License-Identifier: Apache-2.0
// How fast meshes are read from memory, 1.6 million triangles in each format, and their neighbours
// found.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "prt/mesh_io.h"
#include "prt/mesh_topology.h"

namespace {

constexpr unsigned kSide = 895;  // vertices along each side of a wavy square

glm::vec3 position(unsigned i, unsigned j) {
    const auto x = static_cast<float>(i), y = static_cast<float>(j);
    return {0.01f * x, 0.01f * y, std::sin(0.05f * x) * std::cos(0.07f * y)};
}

template <class Vertex, class Triangle>
void visit(const Vertex& vertex, const Triangle& triangle) {
    for (unsigned i = 0; i < kSide; ++i) {
        for (unsigned j = 0; j < kSide; ++j) vertex(position(i, j));
    }
    for (unsigned i = 0; i + 1 < kSide; ++i) {
        for (unsigned j = 0; j + 1 < kSide; ++j) {
            const unsigned a = i * kSide + j, b = a + kSide;
            triangle(a, b, b + 1);
            triangle(a, b + 1, a + 1);
        }
    }
}

template <class... Values>
void print(std::string& text, const char* format, Values... values) {
    char line[160];
    std::snprintf(line, sizeof(line), format, values...);
    text += line;
}

// As this machine has them; readers are told which.
template <class T>
void append(std::string& bytes, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

constexpr unsigned kVertices = kSide * kSide;
constexpr unsigned kTriangles = 2 * (kSide - 1) * (kSide - 1);

std::string make_obj() {
    std::string text;
    visit([&](const glm::vec3& p) { print(text, "v %.6f %.6f %.6f\n", p.x, p.y, p.z); },
          [&](unsigned a, unsigned b, unsigned c) {
              print(text, "f %u %u %u\n", a + 1, b + 1, c + 1);
          });
    return text;
}

std::string make_off() {
    std::string text;
    print(text, "OFF\n%u %u 0\n", kVertices, kTriangles);
    visit([&](const glm::vec3& p) { print(text, "%.6f %.6f %.6f\n", p.x, p.y, p.z); },
          [&](unsigned a, unsigned b, unsigned c) { print(text, "3 %u %u %u\n", a, b, c); });
    return text;
}

std::string make_ply(const char* encoding) {
    std::string text = std::string("ply\nformat ") + encoding + " 1.0\n";
    print(text,
          "element vertex %u\nproperty float x\nproperty float y\nproperty float z\nelement face "
          "%u\nproperty list uchar int vertex_indices\nend_header\n",
          kVertices, kTriangles);
    if (std::string(encoding) == "ascii") {
        visit([&](const glm::vec3& p) { print(text, "%.6f %.6f %.6f\n", p.x, p.y, p.z); },
              [&](unsigned a, unsigned b, unsigned c) { print(text, "3 %u %u %u\n", a, b, c); });
    } else {
        visit([&](const glm::vec3& p) { append(text, p.x), append(text, p.y), append(text, p.z); },
              [&](unsigned a, unsigned b, unsigned c) {
                  append(text, std::uint8_t{3});
                  append(text, a), append(text, b), append(text, c);
              });
    }
    return text;
}

std::string make_stl() {
    std::string text(80, ' ');
    append(text, kTriangles);
    visit([](const glm::vec3&) {},
          [&](unsigned a, unsigned b, unsigned c) {
              text.append(12, '\0');
              for (const unsigned v : {a, b, c}) {
                  const glm::vec3 p = position(v / kSide, v % kSide);
                  append(text, p.x), append(text, p.y), append(text, p.z);
              }
              text.append(2, '\0');
          });
    return text;
}

void read(benchmark::State& state, const std::string& bytes, const char* name) {
    for (auto _ : state) {
        const airlight::Mesh mesh = airlight::parse_mesh(bytes, name);
        if (mesh.triangles.size() != kTriangles) state.SkipWithError("triangles are missing");
        benchmark::DoNotOptimize(mesh.normals.data());
    }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
    state.SetItemsProcessed(state.iterations() * kTriangles);
}

void obj(benchmark::State& state) {
    read(state, make_obj(), "a.obj");
}
void off(benchmark::State& state) {
    read(state, make_off(), "a.off");
}
void ply_ascii(benchmark::State& state) {
    read(state, make_ply("ascii"), "a.ply");
}
void ply_binary(benchmark::State& state) {
    read(state, make_ply("binary_little_endian"), "a.ply");
}
void stl_binary(benchmark::State& state) {
    read(state, make_stl(), "a.stl");
}

void topology(benchmark::State& state) {
    const airlight::Mesh mesh = airlight::parse_mesh(make_obj(), "a.obj");
    for (auto _ : state) benchmark::DoNotOptimize(airlight::mesh_topology(mesh).edges);
    state.SetItemsProcessed(state.iterations() * kTriangles);
}

BENCHMARK(obj)->Unit(benchmark::kMillisecond);
BENCHMARK(off)->Unit(benchmark::kMillisecond);
BENCHMARK(ply_ascii)->Unit(benchmark::kMillisecond);
BENCHMARK(ply_binary)->Unit(benchmark::kMillisecond);
BENCHMARK(stl_binary)->Unit(benchmark::kMillisecond);
BENCHMARK(topology)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
