// SPDX-License-Identifier: Apache-2.0
// What each ladder of a single function is measured on: draws that are always the same.
#include <cmath>
#include <cstdint>
#include <utility>

#include "cli/ladder_closed_forms.h"
#include "cli/ladder_draws.h"
#include "medium/airlight_sets.h"

namespace airlight {
namespace {

constexpr int kInputs = 20000;

std::vector<EvalArguments> airlight_inputs(char set) {
    std::vector<EvalArguments> inputs;
    for (const AirlightCase& c : airlight_set(set, kInputs)) {
        inputs.push_back({c.gamma, c.t_sv, c.t_vp});
    }
    return inputs;
}

std::vector<ClosedFormSet> airlight_ladder_sets() {
    return {
        {"A", "airlight", "optical thicknesses below 2, angles 0.02 … 2.5", airlight_inputs('A')},
        {"B", "airlight-b", "optical thicknesses below 10, angles 0 … π", airlight_inputs('B')}};
}

template <class Draw>
std::vector<EvalArguments> draw_inputs(std::uint64_t seed, int count, const Draw& draw) {
    Draws draws(seed);
    std::vector<EvalArguments> inputs;
    for (int i = 0; i < count; ++i) inputs.push_back(draw(draws));
    return inputs;
}

std::vector<ClosedFormSet> phase_ladder_sets() {
    std::vector<EvalArguments> inputs = airlight_inputs('A');
    for (EvalArguments& row : inputs) row[3] = 0.8;
    return {{"g = 0.8", "phase", "optical thicknesses below 2, angles 0.02 … 2.5, g = 0.8",
             std::move(inputs)}};
}

std::vector<ClosedFormSet> surface_ladder_sets() {
    std::vector<ClosedFormSet> sets;
    for (const double exponent : {1.0, 20.0}) {
        sets.push_back({exponent == 1 ? "n = 1" : "n = 20",
                        exponent == 1 ? "surface" : "surface-20",
                        exponent == 1 ? "a Lambertian surface, n = 1; T below 10, θ in 0 … π"
                                      : "a Phong lobe, n = 20; T below 10, θ in 0 … π",
                        draw_inputs(3, 2000, [exponent](Draws& draws) -> EvalArguments {
                            const double t = draws.uniform(0, 10);
                            return {t, draws.uniform(0, kPi), exponent};
                        })});
    }
    return sets;
}

std::vector<ClosedFormSet> slab_ladder_sets() {
    return {{"slab", "slab", "thicknesses s σ_t in 1e-2 … 10, light at 0.1 … 10 of s",
             draw_inputs(4, 2000, [](Draws& draws) -> EvalArguments {
                 const double s = 1, sigma_t = draws.decades(-2, 1), l = draws.decades(-1, 1);
                 const double a = draws.uniform(0.05, 1), b = draws.uniform(0.05, 1);
                 const double phi = draws.uniform(0, kPi);
                 const double w_dot_wl =
                     a * b + std::sqrt((1 - a * a) * (1 - b * b)) * std::cos(phi);
                 return {sigma_t, s, l, a, b, w_dot_wl};
             })}};
}

std::vector<ClosedFormSet> chapman_ladder_sets() {
    return {{"earth", "chapman", "z in 300 … 6000 (scale heights of 1 … 20 km), θ below 90°",
             draw_inputs(5, kInputs, [](Draws& draws) -> EvalArguments {
                 return {draws.uniform(300, 6000), draws.uniform(0, 1)};
             })}};
}

std::vector<ClosedFormSet> atmosphere_ladder_sets() {
    const auto rays = [](double shortest, double longest) {
        return draw_inputs(6, kInputs, [=](Draws& draws) -> EvalArguments {
            const double r = 6371000 + draws.uniform(0, 60000);
            return {6371000, 8000, r, draws.uniform(-0.05, 1), draws.decades(shortest, longest)};
        });
    };
    return {
        {"long", "atmosphere", "rays of 1 … 1000 km in the air of the earth", rays(3, 6)},
        {"short", "atmosphere-short", "segments of 1 … 100 m in the air of the earth", rays(0, 2)}};
}

std::vector<ClosedFormSet> gaussian_ladder_sets() {
    return {{"blob", "gaussian", "rays past a blob of scale 1 at up to 2 from its middle",
             draw_inputs(7, kInputs, [](Draws& draws) -> EvalArguments {
                 return {1, 1, draws.uniform(0, 2), draws.uniform(-3, 8), draws.uniform(0, 8)};
             })}};
}

}  // namespace

const std::vector<ClosedFormLadder>& closed_form_ladders() {
    static const std::vector<ClosedFormLadder> kLadders = {
        {"airlight", "airlight", "Airlight of a point light",
         "<p>Two sets of 20000 uniform random rays. <b>A</b> is thin: optical thicknesses from "
         "viewer to light and along the ray below 2, angles 0.02 … 2.5; <b>B</b> has "
         "thicknesses below 10, angles 0 … π. Errors are relative to the method "
         "<code>exact</code>, whose own error the tests measure against 40 digits.</p>",
         1e-13, airlight_ladder_sets},
        {"phase", "airlight_hg", "Airlight with a phase function",
         "<p>The rays of set A in a medium that scatters forward as Henyey and Greenstein have it, "
         "g = 0.8.</p>",
         1e-13, phase_ladder_sets},
        {"surface", "surface_Gn", "Light on a surface by way of the fog",
         "<p>G_n of a point light at optical thickness T below 10 and at angles 0 … π from the "
         "lobe, for a Lambertian surface (n = 1) and a Phong lobe (n = 20), 2000 uniform random "
         "draws each. Tables are built before the clock starts.</p>",
         1e-13, surface_ladder_sets},
        {"chapman", "chapman", "The Chapman function",
         "<p>The mass of air along a ray to infinity over that of the vertical column, for 20000 "
         "directions above the horizon.</p>",
         1e-13, chapman_ladder_sets},
        {"atmosphere", "optdepth_sphere", "Optical depth of an atmosphere",
         "<p>Segments in air whose density falls by e every 8 km over a sphere of 6371 km: from "
         "altitudes below 60 km, down to 3° below the horizon. Long ones, and short ones, on which "
         "differences of Chapman functions lose all digits. The distance from the center is a "
         "float "
         "for <code>article</code> and <code>batch</code>, which leaves 3e-5 of it; with altitudes "
         "in its place the batch keeps 1e-6.</p>",
         1e-13, atmosphere_ladder_sets},
        {"gaussian", "gauss_line", "Optical depth of a Gaussian blob",
         "<p>20000 segments past one blob.</p>", 1e-14, gaussian_ladder_sets},
        {"slab", "slab", "A point light over a slab",
         "<p>Light of a point at the distance l from the surface, seen along a path of length s "
         "inside; directions are uniform in the cosines.</p>",
         1e-13, slab_ladder_sets},
    };
    return kLadders;
}

}  // namespace airlight
