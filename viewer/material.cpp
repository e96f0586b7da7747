// SPDX-License-Identifier: Apache-2.0
#include "viewer/material.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace airlight {
namespace {

double mean(const glm::dvec3& c) {
    return (c.x + c.y + c.z) / 3;
}

glm::dvec3 mirrored(const glm::dvec3& normal, const glm::dvec3& v) {
    return 2 * glm::dot(normal, v) * normal - v;
}

// cos^exponent about an axis, as a density over its hemisphere.
double cosine_power_pdf(double cosine, double exponent) {
    return cosine > 0 ? (exponent + 1) / (2 * kPi) * std::pow(cosine, exponent) : 0;
}

glm::dvec3 sample_cosine_power(const glm::dvec3& axis, double exponent, double u, double v) {
    const double cosine = std::pow(1 - u, 1 / (exponent + 1));
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    glm::dvec3 x, y;
    make_axes(axis, x, y);
    return sine * std::cos(2 * kPi * v) * x + sine * std::sin(2 * kPi * v) * y + cosine * axis;
}

// The share of samples that go into the lobe and not the cosine.
double specular_share(const Material& material) {
    const auto* phong = std::get_if<PhongMaterial>(&material);
    if (!phong) return 0;
    const double diffuse = mean(phong->diffuse), specular = mean(phong->specular);
    return diffuse + specular > 0 ? specular / (diffuse + specular) : 0;
}

double exponent_of(const Material& material) {
    const auto* phong = std::get_if<PhongMaterial>(&material);
    return phong ? phong->exponent : 1;
}

glm::dvec3 diffuse_of(const Material& material) {
    if (const auto* lambert = std::get_if<LambertMaterial>(&material)) return lambert->diffuse;
    if (const auto* phong = std::get_if<PhongMaterial>(&material)) return phong->diffuse;
    return glm::dvec3(0);
}

}  // namespace

void make_axes(const glm::dvec3& z, glm::dvec3& x, glm::dvec3& y) {
    const glm::dvec3 other = std::abs(z.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    x = glm::normalize(glm::cross(other, z));
    y = glm::cross(z, x);
}

glm::dvec3 reflect(const Material& material, const glm::dvec3& normal, const glm::dvec3& to_viewer,
                   const glm::dvec3& to_light) {
    const double cosine = glm::dot(normal, to_light);
    if (!(cosine > 0)) return glm::dvec3(0);
    glm::dvec3 result = cosine / kPi * diffuse_of(material);
    if (const auto* phong = std::get_if<PhongMaterial>(&material)) {
        const double along = glm::dot(mirrored(normal, to_viewer), to_light);
        result += cosine_power_pdf(std::min(along, 1.0), phong->exponent) * phong->specular;
    }
    return result;
}

LobeSample sample_lobe(const Material& material, const glm::dvec3& normal,
                       const glm::dvec3& to_viewer, SampleStream& stream) {
    const double choice = stream.next(), u = stream.next(), v = stream.next();
    LobeSample sample;
    sample.direction =
        choice < specular_share(material)
            ? sample_cosine_power(mirrored(normal, to_viewer), exponent_of(material), u, v)
            : sample_cosine_power(normal, 1, u, v);
    sample.pdf = lobe_pdf(material, normal, to_viewer, sample.direction);
    return sample;
}

double lobe_pdf(const Material& material, const glm::dvec3& normal, const glm::dvec3& to_viewer,
                const glm::dvec3& direction) {
    const double share = specular_share(material);
    double pdf = (1 - share) * cosine_power_pdf(glm::dot(normal, direction), 1);
    if (share > 0) {
        const double along = glm::dot(mirrored(normal, to_viewer), direction);
        pdf += share * cosine_power_pdf(std::min(along, 1.0), exponent_of(material));
    }
    return pdf;
}

}  // namespace airlight
