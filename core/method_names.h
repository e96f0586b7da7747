// SPDX-License-Identifier: Apache-2.0
// Methods of one computation by name: the rungs of a ladder as the command line calls them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace airlight {

template <class Method>
struct NamedMethod {
    Method method;
    std::string_view name;
};

/// The name of a method in its table; empty when it is not there.
template <class Method, std::size_t count>
constexpr std::string_view method_name(const NamedMethod<Method> (&table)[count], Method method) {
    for (const NamedMethod<Method>& each : table) {
        if (each.method == method) return each.name;
    }
    return {};
}

/// The method of that name; nothing when the table has none.
template <class Method, std::size_t count>
constexpr std::optional<Method> method_from_name(const NamedMethod<Method> (&table)[count],
                                                 std::string_view name) {
    for (const NamedMethod<Method>& each : table) {
        if (each.name == name) return each.method;
    }
    return std::nullopt;
}

/// All names of a table, that of `first` in front, the others in their order, then `more`.
template <class Method, std::size_t count>
std::vector<std::string> method_names(const NamedMethod<Method> (&table)[count], Method first,
                                      const std::vector<std::string>& more = {}) {
    std::vector<std::string> names = {std::string(method_name(table, first))};
    for (const NamedMethod<Method>& each : table) {
        if (each.method != first) names.emplace_back(each.name);
    }
    names.insert(names.end(), more.begin(), more.end());
    return names;
}

}  // namespace airlight
