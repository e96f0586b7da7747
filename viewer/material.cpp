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
double specular_share(const SurfaceMaterial& material) {
    if (material.table) return 0.5;
    const auto* phong = std::get_if<PhongMaterial>(&material.kind);
    if (!phong) return 0;
    const double diffuse = mean(phong->diffuse), specular = mean(phong->specular);
    return diffuse + specular > 0 ? specular / (diffuse + specular) : 0;
}

double exponent_of(const SurfaceMaterial& material) {
    const auto* phong = std::get_if<PhongMaterial>(&material.kind);
    return phong ? phong->exponent : 1;
}

glm::dvec3 diffuse_of(const SurfaceMaterial& material) {
    if (const auto* lambert = std::get_if<LambertMaterial>(&material.kind)) return lambert->diffuse;
    if (const auto* phong = std::get_if<PhongMaterial>(&material.kind)) return phong->diffuse;
    return glm::dvec3(0);
}

}  // namespace

glm::dvec3 reflect(const SurfaceMaterial& material, const glm::dvec3& normal,
                   const glm::dvec3& to_viewer, const glm::dvec3& to_light) {
    const double cosine = glm::dot(normal, to_light);
    if (!(cosine > 0)) return glm::dvec3(0);
    if (material.table) return cosine * material.table->evaluate(normal, to_viewer, to_light);
    glm::dvec3 result = cosine / kPi * diffuse_of(material);
    if (const auto* phong = std::get_if<PhongMaterial>(&material.kind)) {
        const double along = glm::dot(mirrored(normal, to_viewer), to_light);
        result += cosine_power_pdf(std::min(along, 1.0), phong->exponent) * phong->specular;
    }
    return result;
}

bool is_glossy(const SurfaceMaterial& material) {
    if (material.table) return true;
    const auto* phong = std::get_if<PhongMaterial>(&material.kind);
    return phong && phong->specular != glm::dvec3(0);
}

double most_reflected(const SurfaceMaterial& material) {
    if (material.table) return material.table->most();
    glm::dvec3 most = diffuse_of(material) / kPi;
    if (const auto* phong = std::get_if<PhongMaterial>(&material.kind)) {
        most += cosine_power_pdf(1, phong->exponent) * phong->specular;
    }
    return std::max({most.x, most.y, most.z});
}

LobeSample sample_lobe(const SurfaceMaterial& material, const glm::dvec3& normal,
                       const glm::dvec3& to_viewer, SampleStream& stream) {
    const double choice = stream.next(), u = stream.next(), v = stream.next();
    LobeSample sample;
    if (!(choice < specular_share(material))) {
        sample.direction = sample_cosine_power(normal, 1, u, v);
    } else if (material.table) {
        sample.direction = material.table->sample(normal, to_viewer, u, v);
    } else {
        sample.direction =
            sample_cosine_power(mirrored(normal, to_viewer), exponent_of(material), u, v);
    }
    sample.pdf = lobe_pdf(material, normal, to_viewer, sample.direction);
    return sample;
}

double lobe_pdf(const SurfaceMaterial& material, const glm::dvec3& normal,
                const glm::dvec3& to_viewer, const glm::dvec3& direction) {
    const double share = specular_share(material);
    double pdf = (1 - share) * cosine_power_pdf(glm::dot(normal, direction), 1);
    if (material.table) return pdf + share * material.table->pdf(normal, to_viewer, direction);
    if (share > 0) {
        const double along = glm::dot(mirrored(normal, to_viewer), direction);
        pdf += share * cosine_power_pdf(std::min(along, 1.0), exponent_of(material));
    }
    return pdf;
}

}  // namespace airlight
