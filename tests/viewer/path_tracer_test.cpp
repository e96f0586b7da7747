// SPDX-License-Identifier: Apache-2.0
#include "viewer/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.h"
#include "core/threads.h"
#include "medium/airlight.h"
#include "medium/point_glow.h"
#include "tests/viewer/scene_fixture.h"
#include "viewer/media_sampling.h"
#include "viewer/reference_picture.h"

namespace airlight {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct SampleMean {
    glm::dvec3 mean{0}, squares{0};
    int count = 0;

    void add(const glm::dvec3& sample) {
        ++count;
        const glm::dvec3 before = sample - mean;
        mean += before / double(count);
        squares += before * (sample - mean);
    }
    double error(int channel) const {
        return std::sqrt(squares[channel] / (double(count) * (count - 1)));
    }
};

SceneMedium with_hg(SceneMedium medium, double g) {
    medium.phase.type = PhaseType::henyey_greenstein;
    medium.phase.g = g;
    return medium;
}

class PathTracerTest : public SceneFixture {
  protected:
    void add_object(Scene& scene, const std::string& name, const Material& material,
                    const glm::dmat4& transform = glm::dmat4(1)) const {
        SceneObject object;
        object.mesh = file(name);
        object.material = material;
        object.transform = transform;
        scene.objects.push_back(object);
    }
    /// A floor of 40 m at y = -1.
    void add_floor(Scene& scene, const Material& material) const {
        std::ofstream(directory_ / "floor.obj")
            << "v -20 -1 -20\nv -20 -1 20\nv 20 -1 20\nv 20 -1 -20\nf 1 2 3\nf 1 3 4\n";
        add_object(scene, "floor.obj", material);
    }
    /// A box of 2 x 1 x 3 m; its faces share no corners, so their normals are their own.
    void write_room() const {
        std::ofstream out(directory_ / "room.obj");
        const glm::dvec3 size(2, 1, 3);
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
            for (int corner = 0; corner < 4; ++corner) {
                glm::dvec3 x(0);
                x[axis] = face % 2 * size[axis];
                x[a] = (corner == 1 || corner == 2 ? 1 : 0) * size[a];
                x[b] = corner / 2 * size[b];
                out << "v " << x.x << " " << x.y << " " << x.z << "\n";
            }
            const int first = 4 * face + 1;
            out << "f " << first << " " << first + 1 << " " << first + 2 << " " << first + 3
                << "\n";
        }
    }

    // Rays into a pyramid of 9 degrees about -Z, one sample each, the same for both.
    template <class Renderer>
    SampleMean mean_of(const Renderer& renderer, const glm::dvec3& eye, int samples,
                       std::uint64_t pixel) {
        SampleMean mean;
        for (int i = 0; i < samples; ++i) {
            SampleStream stream(pixel, static_cast<std::uint64_t>(i));
            const double x = stream.next() - 0.5, y = stream.next() - 0.5;
            mean.add(renderer.radiance(eye, glm::normalize(glm::dvec3(0.15 * x, 0.15 * y, -1)),
                                       stream, counts_));
        }
        return mean;
    }
    void expect_single_is_reference(const Scene& scene, int samples) {
        const World world(scene);
        PathTracerOptions single;
        single.single = true;
        const glm::dvec3 eye(0, 0.3, 5);
        const SampleMean paths = mean_of(PathTracer(world, single), eye, samples, 1);
        ReferenceOptions quadrature;
        quadrature.quadrature = 1e-3;
        const SampleMean truth = mean_of(ReferenceRenderer(world, quadrature), eye, samples / 6, 2);
        for (int c = 0; c < 3; ++c) {
            const double error = std::hypot(paths.error(c), truth.error(c));
            EXPECT_LT(error, 5e-3 * truth.mean[c]) << "too few samples to tell";
            EXPECT_NEAR(paths.mean[c], truth.mean[c], 3 * error) << c;
        }
    }
};

TEST_F(PathTracerTest, ScatteredOnceAlongRaysItIsTheReference) {
    Scene scene;
    scene.lights = {{{2, 2.2, 2}, glm::dvec3(3, 2, 1)}};
    scene.media = {uniform_medium(0.2, 0.05)};
    {
        SCOPED_TRACE("fog");
        expect_single_is_reference(scene, 60000);
    }
    {
        SCOPED_TRACE("hg");
        scene.media = {with_hg(uniform_medium(0.2, 0), 0.7)};
        expect_single_is_reference(scene, 60000);
    }
    {
        SCOPED_TRACE("coloured, two phase functions");
        scene.media = {uniform_medium(0.1, 0), with_hg(uniform_medium(0.1, 0.1), -0.5)};
        scene.media[0].kind = SceneUniform{{0.05, 0.2, 0.6}, {0, 0.1, 0}};
        expect_single_is_reference(scene, 60000);
    }
    {
        SCOPED_TRACE("Gaussians, thin fog, a layer and a box");
        SceneMedium steam, layer;
        steam.kind = SceneGaussians{
            {{{0, 0, 0}, 1, 0.8}, {{0.5, 0.8, 1.2}, 3, 3}}, {}, glm::dvec3(0.5, 1, 1)};
        layer.kind = SceneExponentialHeight{glm::dvec3(0.05, 0.06, 0.1), 3, glm::dvec3(0.9)};
        scene.media = {uniform_medium(0.01, 0), steam, layer, with_hg(uniform_medium(0.3, 0), 0.4)};
        scene.media[3].bounds = SceneBox{{-3, 0.2, -4}, {3, 0.6, 3}};
        expect_single_is_reference(scene, 60000);
    }
}

TEST_F(PathTracerTest, ScatteredOnceOnSurfacesItIsTheReference) {
    Scene scene;
    scene.lights = {{{2, 2.2, 2}, glm::dvec3(3, 2, 1)}, {{-5, 3, -2}, glm::dvec3(4)}};
    scene.media = {uniform_medium(0.1, 0.02)};
    PhongMaterial phong;
    phong.exponent = 5;
    add_floor(scene, LambertMaterial{{0.6, 0.5, 0.3}});
    add_ball(scene, glm::dvec3(0), 0.7, 6, phong);
    {
        SCOPED_TRACE("lamps");
        expect_single_is_reference(scene, 200000);
    }
    {
        SCOPED_TRACE("many lamps, some of which are drawn");
        Scene many = scene;
        for (int i = 0; i < 10; ++i) {
            many.lights.push_back({{i - 5.0, 2 + 0.3 * i, -4.0 + i % 3}, glm::dvec3(0.3 * i)});
        }
        expect_single_is_reference(many, 160000);
    }
    {
        SCOPED_TRACE("a sky, too");
        // To fog without end the reference's map is a sphere of lights, the tracer's is not.
        scene.media[0].bounds = SceneBox{glm::dvec3(-6), glm::dvec3(6)};
        add_sky(scene, 0.2, 25);
        expect_single_is_reference(scene, 200000);
    }
}

TEST_F(PathTracerTest, AFurnaceIsAsBrightAsItsWalls) {
    // Nothing absorbs, so every path of light ends at the sky, which is 1 everywhere.
    Scene scene;
    add_sky(scene, 1, 50);
    SceneMedium rayleigh = uniform_medium(0.7, 0), steam;
    rayleigh.phase.type = PhaseType::rayleigh;
    rayleigh.bounds = SceneBox{{-1, -1, -1}, {1, 1, 1}};
    steam.kind = SceneGaussians{{{{0.2, 0.1, 0.5}, 2, 3}}, {}, glm::dvec3(1)};
    scene.media = {rayleigh, with_hg(steam, 0.8)};
    scene.media.push_back(uniform_medium(0, 0));
    scene.media[2].kind = SceneUniform{{0.02, 0.1, 0.5}, glm::dvec3(0)};
    scene.media[2].bounds = SceneBox{{-2, -0.5, -0.5}, {2, 0.5, 0.5}};
    for (const bool box : {false, true}) {
        if (box) {
            write_room();
            glm::dmat4 small(0.5);
            small[3] = {-0.4, -0.2, -1, 1};
            add_object(scene, "room.obj", LambertMaterial{glm::dvec3(1)}, small);
        }
        const World world(scene);
        const SampleMean mean = mean_of(PathTracer(world, {}), {0, 0, 3}, 20000, 3);
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(mean.error(c), 5e-3);
            EXPECT_NEAR(mean.mean[c], 1, 3 * mean.error(c) + 1e-12) << box << c;
        }
    }
}

TEST_F(PathTracerTest, ARoomThatOnlyItsWallsDarkenKeepsTheLampsPower) {
    // All light ends in the walls: their mean irradiance is 4 pi I / (A (1 - albedo)), whatever the
    // fog in between does, unless it absorbs.
    constexpr double kAlbedo = 0.5, kIntensity = 2;
    for (const double g : {0.0, 0.6}) {
        Scene scene;
        write_room();
        add_object(scene, "room.obj", LambertMaterial{glm::dvec3(kAlbedo)});
        scene.lights = {{{0.8, 0.6, 1.2}, glm::dvec3(kIntensity)}};
        scene.media = {with_hg(uniform_medium(0.5, 0), g)};
        const World world(scene);
        const PathTracer tracer(world, {});
        const double area = 2 * (2 * 1 + 2 * 3 + 1 * 3);
        const double expected = kAlbedo * 4 * kIntensity / (area * (1 - kAlbedo));
        SampleMean mean;
        for (int i = 0; i < 250000; ++i) {
            SampleStream stream(5, static_cast<std::uint64_t>(i));
            // A point of the walls, seen from close by.
            double choice = stream.next() * area / 2;
            const double u = stream.next(), v = stream.next();
            const glm::dvec3 size(2, 1, 3);
            glm::dvec3 x(0), normal(0);
            for (int axis = 0; axis < 3; ++axis) {
                const int a = (axis + 1) % 3, b = (axis + 2) % 3;
                const double side = size[a] * size[b];
                if (!(choice < side)) {
                    choice -= side;
                    continue;
                }
                const bool far = choice < side / 2;
                x[a] = u * size[a];
                x[b] = v * size[b];
                x[axis] = far ? size[axis] : 0;
                normal[axis] = far ? -1 : 1;
                break;
            }
            mean.add(tracer.radiance(x + 1e-4 * normal, -normal, stream, counts_));
        }
        EXPECT_LT(mean.error(0), 1e-2 * expected);
        // 1e-4 m of fog take some and add some, at most 2e-4 of it.
        EXPECT_NEAR(mean.mean.x, expected, 3 * mean.error(0) + 2e-4 * expected) << g;
    }
}

TEST_F(PathTracerTest, GlowsInEndlessFogAreThoseOfTransportTheory) {
    // Where nothing is absorbed, more than N points bring (3 / (4 pi))^{3/2} 2 / sqrt(N) to all
    // points near a light of unit power.
    constexpr double kMissing = 0.2334 / 32;
    PathTracerOptions options;
    options.max_bounces = 1024;
    for (const double albedo : {1.0, 0.9}) {
        Scene scene;
        scene.lights = {{{0, 0, 0}, glm::dvec3(1)}};
        scene.media = {uniform_medium(0.5 * albedo, 0.5 * (1 - albedo))};
        const World world(scene);
        const PathTracer tracer(world, options);
        const PointGlow glow(albedo);
        for (const double gamma : {0.2, 1.0}) {
            const double t_sv = albedo < 1 ? 1.5 : 0.5;
            const glm::dvec3 eye(0, 0, 2 * t_sv);
            SampleMean mean;
            for (int i = 0; i < 100000; ++i) {
                SampleStream stream(1, static_cast<std::uint64_t>(i));
                mean.add(
                    tracer.radiance(eye, {std::sin(gamma), 0, -std::cos(gamma)}, stream, counts_));
            }
            const double missing = albedo < 1 ? 0 : kMissing;
            const double expected = 0.25 * (glow.radiance(gamma, t_sv, kInfinite) - missing);
            EXPECT_LT(mean.error(0), 1.5e-2 * expected);
            EXPECT_NEAR(mean.mean.x, expected, 3 * mean.error(0)) << albedo << " " << gamma;
            // Single scattering would be far off.
            EXPECT_GT(expected, 1.2 * 0.25 * albedo * airlight(gamma, t_sv, kInfinite));
        }
    }
}

TEST_F(PathTracerTest, APictureStopsAsAWholeAtItsToleranceForAnyNumberOfThreads) {
    Scene scene;
    scene.lights = {{{0.5, 1, 0}, glm::dvec3(1)}};
    scene.media = {uniform_medium(0.3, 0.1)};
    scene.camera.position = {0, 0, 3};
    scene.camera.look_at = {0, 0, 0};
    const World world(scene);
    ReferencePictureOptions options;
    options.scattering = Scattering::multiple;
    options.width = 12;
    options.height = 8;
    options.samples = 4096;
    options.tolerance = 0.02;
    std::vector<float> one;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        const ReferencePicture picture = render_reference(world, options);
        EXPECT_LE(picture.noise, 0.02);
        EXPECT_EQ(picture.unfinished, 0u);
        EXPECT_EQ(picture.samples % (12 * 8 * kFirstSamples), 0u);
        EXPECT_LT(picture.samples, 12u * 8 * 4096);
        if (one.empty()) one = picture.image.pixels;
        EXPECT_EQ(picture.image.pixels, one);
    }
    options.samples = 3;
    EXPECT_EQ(render_reference(world, options).samples, 12u * 8 * 3);
}

TEST_F(PathTracerTest, RefusesSlabsAndNoPoints) {
    Scene scene;
    const World empty(scene);
    PathTracerOptions none;
    none.max_bounces = 0;
    EXPECT_THROW(PathTracer(empty, none), Error);
    SceneMedium slab;
    slab.kind = SceneSlab{SceneBox{glm::dvec3(0), glm::dvec3(1)}, 1.3, glm::dvec3(1), {}};
    scene.media = {slab};
    EXPECT_THROW(PathTracer(World(scene), {}), Error);
}

}  // namespace
}  // namespace airlight
