#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "bernal/core/spheres.hpp"
#include "bernal/measure/contact_list.hpp"
#include "files/output_file.hpp"
#include "result/write_layers.hpp"

namespace bernal {

/// ParaView's PolyData: one vertex cell a sphere, point data `radius`, `id` (the sphere's line in
/// spheres.csv, counted from 0) and, where they are given, `coordination`, `class` (of every sphere) and
/// more, all as 64-bit appended raw data. In ParaView: Glyph, type Sphere, radius 1, scale array `radius`,
/// scale factor 1; or representation Point Gaussian. Points have three coordinates: missing ones are 0, and
/// those beyond the third are the point data `x3`, `x4`, … . A comment says the dimension and, where one is
/// given, the unit: "lengths in mm; dimension 2".
void write_vtp(OutputFile& file, const Spheres<dynamic>& spheres, std::string_view unit = {},
               std::span<const std::uint32_t> coordination = {}, std::span<const std::uint32_t> classes = {},
               const std::vector<NamedColumn>& more = {});

/// Contacts as PolyData: a line each between the two centres, seen from sphere i, or from the centre to the
/// wall, with the cell data i, j, gap and normal (three components). Otherwise as `write_vtp`.
void write_contacts_vtp(OutputFile& file, const ContactList& contacts, const Spheres<dynamic>& spheres,
                        std::string_view unit = {});
/// What such a file says in its first lines.
inline constexpr std::string_view contacts_in_vtp = "contacts of spheres";

}  // namespace bernal
