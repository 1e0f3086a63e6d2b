#pragma once
#include <filesystem>

#include "bernal/measure/contact_list.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// All contacts in a file of the kind that its name ends in, lengths in the scene's unit:
/// - .csv: "# unit: mm", the header "i,j,gap,nx,ny,nz,x,y,z" (in other than three dimensions
///   "i,j,gap,n0,n1,…,x0,x1,…"), then one contact a line; i and j count from 0 in the order of spheres.csv,
///   and j is -1 at a wall. Numbers read back to the bit.
/// - .npy: the same columns as doubles, a row for each contact.
/// - .vtp: a line for each between the centres, or to the wall, with i, j, gap and normal; for ParaView.
///
/// See `ContactList` for what the columns mean. Takes the place of such a file; throws Error{cannot_write}
/// where another one stands, or one that belongs to a result, and Error{bad_argument} for another ending.
void write_contacts(const Packing&, const ContactList&, const std::filesystem::path& file);

/// Throws now what `write_contacts` would throw later of the file and its name.
void check_contacts_file(const std::filesystem::path& file, int dimension);

}  // namespace bernal
