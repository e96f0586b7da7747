// SPDX-License-Identifier: Apache-2.0
// Rays per CPU second of the baker, beside Embree's alone, on one thread.
//
// In each round every contender takes a turn on each block of 512 vertices, in the same rays:
//     rays alone       a loop that only calls rtcOccluded1M with 256 rays, made before the clock
//     bake_vertices    visibility and shadowed transfer, rays made and checked, results written
//     straightforward  rtcOccluded1 ray by ray and the basis evaluated for each that is free
//     one bounce       bake_vertices of transfer with the mesh itself as a reflector
//     nearest hits     find_hits for all rays and no more, what a bounce cost that did not begin
//                      with the blocked ones
// Ratios are of rays per CPU second, medians over the rounds. Without a file the mesh is a bumpy
// sphere.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/rounds.h"
#include "cli/ladder_sphere.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/threads.h"
#include "prt/bake.h"
#include "prt/embree_scene.h"
#include "prt/hemisphere.h"
#include "prt/mesh_io.h"
#include "prt/morton.h"
#include "sh/basis.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr std::size_t kBlock = 512;
constexpr int kContenders = 5;

struct Contest {
    const Mesh& mesh;
    const RayScene& scene;
    BakeOptions options;
    HemisphereDirections local;
    std::vector<RTCRay> rays;
    std::vector<float> visibility, transfer, reflected;
    std::vector<RayHit> nearest;
    std::size_t hits = 0;

    Contest(const Mesh& m, const RayScene& s, const BakeOptions& o)
        : mesh(m),
          scene(s),
          options(o),
          local(fibonacci_hemisphere(static_cast<std::size_t>(o.rays))),
          rays(local.count()),
          visibility(kBlock * sh_count(o.order)),
          transfer(visibility.size()),
          reflected(sh_count(o.order) * m.positions.size(), 0.1f),
          nearest(local.count()) {}

    void make_rays(std::uint32_t v) {
        const glm::vec3 origin = scene.origin(mesh.positions[v], mesh.normals[v]);
        const glm::mat3 frame(vertex_frame(mesh.normals[v], v));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const glm::vec3 d = frame * glm::vec3(local.x[i], local.y[i], local.z[i]);
            rays[i] = RTCRay{origin.x, origin.y, origin.z, 0,          d.x, d.y,
                             d.z,      0,        INFINITY, 0xffffffff, 0,   0};
        }
    }

    double rays_alone(const std::uint32_t* vertices, std::size_t count) {
        RTCIntersectContext context = detail::incoherent_context();
        double seconds = 0;
        for (std::size_t k = 0; k < count; ++k) {
            make_rays(vertices[k]);
            const detail::FlushDenormals flush;
            const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
            for (std::size_t i = 0; i < rays.size(); i += detail::kRayPacket) {
                const std::size_t size = std::min(detail::kRayPacket, rays.size() - i);
                rtcOccluded1M(scene.embree().scene, &context, &rays[i], static_cast<unsigned>(size),
                              sizeof(RTCRay));
            }
            seconds += clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
            for (const RTCRay& ray : rays) hits += ray.tfar < 0 ? 1 : 0;
        }
        return seconds;
    }

    double bake(const std::uint32_t* vertices, std::size_t count) {
        BakeRows rows;
        rows.visibility = visibility.data();
        rows.transfer = transfer.data();
        const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        hits += bake_vertices(mesh, scene, options, vertices, count, rows).blocked;
        return clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    }

    double bounce(const std::uint32_t* vertices, std::size_t count) {
        BakeRows rows;
        rows.transfer = transfer.data();
        const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        hits += bake_vertices(mesh, scene, options, vertices, count, rows,
                              {{&mesh, 0.5, reflected.data()}})
                    .blocked;
        return clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    }

    double nearest_hits(const std::uint32_t* vertices, std::size_t count) {
        const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t v = vertices[k];
            hits += scene.find_hits(scene.origin(mesh.positions[v], mesh.normals[v]),
                                    glm::mat3(vertex_frame(mesh.normals[v], v)), local.count(),
                                    local.x.data(), local.y.data(), local.z.data(), nearest.data());
        }
        return clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    }

    double turn(std::size_t who, const std::uint32_t* vertices, std::size_t count) {
        switch (who) {
            case 0:
                return rays_alone(vertices, count);
            case 1:
                return bake(vertices, count);
            case 2:
                return straightforward(vertices, count);
            case 3:
                return bounce(vertices, count);
            default:
                return nearest_hits(vertices, count);
        }
    }

    double straightforward(const std::uint32_t* vertices, std::size_t count) {
        const std::size_t size = sh_count(options.order);
        std::vector<float> basis(size);
        std::vector<double> seen(size), sent(size);
        const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        const detail::FlushDenormals flush;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t v = vertices[k];
            const glm::vec3 origin = scene.origin(mesh.positions[v], mesh.normals[v]);
            const glm::mat3 frame(vertex_frame(mesh.normals[v], v));
            std::fill(seen.begin(), seen.end(), 0.0);
            std::fill(sent.begin(), sent.end(), 0.0);
            for (std::size_t i = 0; i < local.count(); ++i) {
                const glm::vec3 d = frame * glm::vec3(local.x[i], local.y[i], local.z[i]);
                RTCRay ray{origin.x, origin.y, origin.z, 0,          d.x, d.y,
                           d.z,      0,        INFINITY, 0xffffffff, 0,   0};
                rtcOccluded1(scene.embree().scene, &context, &ray);
                if (ray.tfar < 0) {
                    ++hits;
                    continue;
                }
                evaluate_basis(options.order, d.x, d.y, d.z, basis.data());
                for (std::size_t j = 0; j < size; ++j) {
                    seen[j] += basis[j];
                    sent[j] += local.z[i] * basis[j];
                }
            }
            const double weight = 2 * kPi / static_cast<double>(local.count());
            for (std::size_t j = 0; j < size; ++j) {
                visibility[k * size + j] = static_cast<float>(weight * seen[j]);
                transfer[k * size + j] = static_cast<float>(weight / kPi * sent[j]);
            }
        }
        return clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    }
};

double relative_rms(const std::vector<float>& values, const std::vector<float>& truth) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        error += std::pow(double(values[i]) - truth[i], 2);
        size += std::pow(double(truth[i]), 2);
    }
    return std::sqrt(error / size);
}

// Error and time of each number of rays, against a bake of very many.
void print_errors(const Mesh& mesh, const RayScene& scene, BakeOptions options,
                  const std::vector<std::uint32_t>& vertices, int truth_rays) {
    const std::size_t size = vertices.size() * sh_count(options.order);
    std::vector<float> seen(size), sent(size), true_seen(size), true_sent(size);
    std::uint64_t traced = 0;
    const auto bake = [&](int rays, std::vector<float>& visibility, std::vector<float>& transfer) {
        options.rays = rays;
        BakeRows rows;
        rows.visibility = visibility.data();
        rows.transfer = transfer.data();
        return measure([&] {
            traced =
                bake_vertices(mesh, scene, options, vertices.data(), vertices.size(), rows).rays;
        });
    };
    bake(truth_rays, true_seen, true_sent);
    fmt::print("\nrelative RMS error against {} rays\n{:>8}{:>14}{:>14}{:>20}\n", truth_rays,
               "rays", "visibility", "transfer", "CPU us per vertex");
    const auto print = [&](double cpu) {
        fmt::print("{:8}{:14.5f}{:14.5f}{:20.1f}\n", traced / vertices.size(),
                   relative_rms(seen, true_seen), relative_rms(sent, true_sent),
                   1e6 * cpu / double(vertices.size()));
    };
    for (int rays = 128; rays < truth_rays; rays *= 2) print(bake(rays, seen, sent).cpu);
    fmt::print("adaptive, to a tolerance of 1e-2, 3e-3, 1e-3, 5e-4\n");
    options.method = BakeMethod::adaptive;
    for (const double tolerance : {1e-2, 3e-3, 1e-3, 5e-4}) {
        options.tolerance = tolerance;
        print(bake(kAdaptiveBakeRays, seen, sent).cpu);
    }
}

void run(const std::string& file, unsigned steps, std::size_t most, int rounds, int truth_rays,
         const BakeOptions& options) {
    const ThreadLimit limit(1);
    const Mesh mesh = file.empty() ? bumpy_sphere(steps, 0.12) : read_mesh(file);
    const Seconds build = measure([&] { RayScene{mesh}; });
    const RayScene scene(mesh);
    std::vector<std::uint32_t> vertices = morton_order(mesh);
    // Runs of neighbours, spread over the whole mesh.
    if (most > 0 && most < vertices.size()) {
        std::vector<std::uint32_t> some;
        const std::size_t stride = (vertices.size() + most - 1) / most;
        for (std::size_t begin = 0; begin < vertices.size(); begin += stride * kBlock) {
            const std::size_t end = std::min(vertices.size(), begin + kBlock);
            some.insert(some.end(), vertices.begin() + static_cast<std::ptrdiff_t>(begin),
                        vertices.begin() + static_cast<std::ptrdiff_t>(end));
        }
        vertices = some;
    }
    fmt::print("{}: {} vertices, {} triangles; {} MiB for Embree, {} at its peak, {:.2f} CPU s\n",
               file.empty() ? "bumpy sphere" : file, mesh.positions.size(), mesh.triangles.size(),
               scene.report().bytes >> 20, scene.report().peak_bytes >> 20, build.cpu);
    fmt::print("order {}, {} rays for each of {} vertices, {} rounds\n", options.order,
               options.rays, vertices.size(), rounds);

    Contest contest(mesh, scene, options);
    std::vector<double> speed[kContenders], of_rays[kContenders], of_plain[kContenders];
    double free = 0;
    for (int round = 0; round < rounds; ++round) {
        double seconds[kContenders] = {};
        std::size_t hits[kContenders] = {};
        std::size_t turn = static_cast<std::size_t>(round);
        for (std::size_t k = 0; k < vertices.size(); k += kBlock, ++turn) {
            const std::size_t count = std::min(kBlock, vertices.size() - k);
            for (std::size_t i = 0; i < kContenders; ++i) {
                const std::size_t who = (turn + i) % kContenders;
                contest.hits = 0;
                seconds[who] += contest.turn(who, &vertices[k], count);
                hits[who] += contest.hits;
            }
        }
        const double all = static_cast<double>(vertices.size()) * options.rays;
        for (int who = 0; who < kContenders; ++who) {
            speed[who].push_back(all / seconds[who]);
            of_rays[who].push_back(seconds[0] / seconds[who]);
            of_plain[who].push_back(seconds[2] / seconds[who]);
            // Different traversals may disagree about rays beside an edge.
            if (std::abs(double(hits[who]) - double(hits[0])) > 1e-4 * all) {
                throw Error(ErrorCode::data, "the contenders' rays differ");
            }
        }
        free = 1 - static_cast<double>(hits[0]) / all;
    }
    fmt::print("{:.1f} % of the rays are free\n\n", 100 * free);
    fmt::print("{:18}{:>12}{:>14}{:>20}\n", "", "Mrays/CPU s", "of rays alone",
               "of straightforward");
    const char* const names[] = {"rays alone", "bake_vertices", "straightforward", "one bounce",
                                 "nearest hits"};
    for (int who = 0; who < kContenders; ++who) {
        fmt::print("{:18}{:12.2f}{:13.1f}%{:20.2f}\n", names[who], median(speed[who]) / 1e6,
                   100 * median(of_rays[who]), median(of_plain[who]));
    }
    if (truth_rays > 0) print_errors(mesh, scene, options, vertices, truth_rays);
}

}  // namespace
}  // namespace airlight

int main(int argc, char** argv) {
    CLI::App app("Rays per CPU second of the baker beside Embree's alone");
    std::string file;
    unsigned steps = 180;
    std::size_t most = 4096;
    int rounds = 5, truth_rays = 0;
    airlight::BakeOptions options;
    app.add_option("mesh", file, "OBJ, PLY, STL or OFF");
    app.add_option("--steps", steps, "rows of the bumpy sphere");
    app.add_option("--vertices", most, "at most so many vertices, 0 for all");
    app.add_option("--rounds", rounds)->check(CLI::Range(1, 1000));
    app.add_option("--order", options.order);
    app.add_option("--rays", options.rays);
    app.add_option("--truth", truth_rays, "also errors, against a bake of so many rays");
    CLI11_PARSE(app, argc, argv);
    try {
        airlight::run(file, steps, most, rounds, truth_rays, options);
    } catch (const airlight::Error& error) {
        fmt::print(stderr, "bake_bench: {}\n", error.describe());
        return 1;
    }
    return 0;
}
