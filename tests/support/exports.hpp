#pragma once
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"
#include "support/folder.hpp"

// Files of other programs as those read them: written after the programs' own descriptions, not after ours.
namespace bernal::testing::exports {

/// What a program has once it has read a file.
struct ReadBack {
  std::vector<std::array<double, 3>> centers;
  std::vector<double> radii;
  std::vector<int> types;  ///< of no file that has none
  std::array<double, 3> lower{}, upper{};
  bool has_box = false;

  void add(std::array<double, 3> center, double radius) {
    centers.push_back(center);
    radii.push_back(radius);
  }
};

inline std::vector<std::string> lines_in(const std::filesystem::path& file) {
  std::istringstream in(text_of(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::vector<std::string> words_in(const std::string& line, const std::string& between = " \t") {
  std::vector<std::string> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(between, at)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(between, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

inline double number(const std::string& word) {
  std::size_t end = 0;
  const double value = std::stod(word, &end);
  if (end != word.size()) throw std::runtime_error("no number: " + word);
  return value;
}

inline void demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

/// read_data of LAMMPS: the first line is a comment; headers in any order; then a heading, an empty line and
/// `id type diameter density x y z`. Density of every atom in `density`.
inline ReadBack read_lammps(const std::filesystem::path& file, double& density) {
  ReadBack read;
  std::size_t atoms = 0, at = 1, types = 0;
  const auto lines = lines_in(file);
  for (; at < lines.size(); ++at) {
    const auto words = words_in(lines[at].substr(0, lines[at].find('#')));
    if (words.empty()) continue;
    if (words.size() == 2 && words[1] == "atoms") atoms = std::stoul(words[0]);
    if (words.size() == 3 && words[1] == "atom" && words[2] == "types") types = std::stoul(words[0]);
    if (words.size() == 4 && words[3].ends_with("hi")) {
      const auto axis = static_cast<std::size_t>(words[3][0] - 'x');
      read.lower[axis] = number(words[0]);
      read.upper[axis] = number(words[1]);
    }
    if (words[0] == "Atoms") break;
  }
  read.has_box = true;
  demand(lines.at(at + 1).empty(), "no empty line after the heading");
  for (at += 2; at < lines.size(); ++at) {
    const auto words = words_in(lines[at]);
    demand(words.size() == 7, "not seven columns: " + lines[at]);
    demand(std::stoul(words[0]) == read.radii.size() + 1, "identifiers out of order");
    read.add({number(words[4]), number(words[5]), number(words[6])}, number(words[2]) / 2);
    read.types.push_back(std::stoi(words[1]));
    demand(read.types.back() >= 1 && read.types.back() <= static_cast<int>(types), "type out of range");
    density = number(words[3]);
  }
  demand(read.radii.size() == atoms, "other count than said");
  return read;
}

/// ymport.textExt of YADE, which fails on an empty line.
inline ReadBack read_yade(const std::filesystem::path& file) {
  ReadBack read;
  const auto lines = lines_in(file);
  demand(lines.at(0) == "#format x_y_z_r", "no format");
  for (const std::string& line : lines) {
    demand(!line.empty(), "an empty line");
    if (line[0] == '#') continue;
    const auto words = words_in(line, "\t");
    demand(words.size() == 4, "not four columns: " + line);
    read.add({number(words[0]), number(words[1]), number(words[2])}, number(words[3]));
  }
  return read;
}

/// LSMGeometry 1.2 of ESyS-Particle.
inline ReadBack read_esys(const std::filesystem::path& file) {
  std::istringstream in(text_of(file));
  const auto expect = [&](const std::string& word) {
    std::string found;
    in >> found;
    demand(found == word, "expected " + word + ", found " + found);
  };
  ReadBack read;
  read.has_box = true;
  expect("LSMGeometry");
  expect("1.2");
  expect("BoundingBox");
  for (double& x : read.lower) in >> x;
  for (double& x : read.upper) in >> x;
  expect("PeriodicBoundaries");
  for (int k = 0, period = 0; k < 3; ++k) in >> period;
  expect("Dimension");
  std::string dimension;
  in >> dimension;
  demand(dimension == "2D" || dimension == "3D", "dimension " + dimension);
  expect("BeginParticles");
  expect("Simple");
  std::size_t count = 0;
  in >> count;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::string, 4> words;
    for (std::string& word : words) in >> word;
    read.add({number(words[0]), number(words[1]), number(words[2])}, number(words[3]));
    std::size_t id = 0;
    read.types.emplace_back();
    in >> id >> read.types.back();
    demand(id == i, "identifiers out of order");
  }
  for (const char* word : {"EndParticles", "BeginConnect", "0", "EndConnect"}) expect(word);
  return read;
}

/// The value of key="…" or key=… in the second line of an extended XYZ file.
inline std::string extxyz_value(const std::string& comment, const std::string& key) {
  const std::size_t at = comment.find(key + "=");
  demand(at != comment.npos, "no " + key);
  const std::size_t from = at + key.size() + 1;
  return comment[from] == '"' ? comment.substr(from + 1, comment.find('"', from + 1) - from - 1)
                              : comment.substr(from, comment.find(' ', from) - from);
}

inline ReadBack read_extxyz(const std::filesystem::path& file) {
  ReadBack read;
  const auto lines = lines_in(file);
  demand(std::stoul(lines.at(0)) + 2 == lines.size(), "other count than said");
  const std::string properties = extxyz_value(lines.at(1), "Properties");
  const std::string plain = "id:I:1:species:S:1:pos:R:3:radius:R:1";
  demand(properties == plain || properties == plain + ":class:I:1", "properties " + properties);
  const auto lattice = words_in(extxyz_value(lines[1], "Lattice")),
             origin = words_in(extxyz_value(lines[1], "Origin"));
  demand(lattice.size() == 9 && origin.size() == 3, "a lattice of three vectors and an origin");
  read.has_box = true;
  for (std::size_t k = 0; k < 3; ++k) {
    read.lower[k] = number(origin[k]);
    read.upper[k] = read.lower[k] + number(lattice[4 * k]);
  }
  for (std::size_t i = 2; i < lines.size(); ++i) {
    const auto words = words_in(lines[i]);
    demand(words.size() == (properties == plain ? 6 : 7), "columns: " + lines[i]);
    demand(words[1] == "X", "an element");
    read.add({number(words[2]), number(words[3]), number(words[4])}, number(words[5]));
    if (words.size() == 7) read.types.push_back(std::stoi(words[6]));
  }
  return read;
}

/// The commands `model domain` and `ball create` of Itasca's PFC.
inline ReadBack read_pfc(const std::filesystem::path& file, int dimension) {
  ReadBack read;
  const auto axes = static_cast<std::size_t>(dimension);
  for (const std::string& line : lines_in(file)) {
    const auto words = words_in(line.substr(0, line.find(';')));
    if (words.size() > 3 && words[1] == "domain") {
      read.has_box = true;
      for (std::size_t k = 0; k < axes; ++k) {
        read.lower[k] = number(words.at(3 + 2 * k));
        read.upper[k] = number(words.at(4 + 2 * k));
      }
    }
    if (words.size() < 2 || words[0] != "ball" || words[1] != "create") continue;
    demand(words[2] == "id" && words[4] == "radius" && words[6] == "position", "keywords: " + line);
    demand(std::stoul(words[3]) == read.radii.size() + 1, "identifiers out of order");
    std::array<double, 3> center{};
    for (std::size_t k = 0; k < axes; ++k) center[k] = number(words.at(7 + k));
    read.add(center, number(words[5]));
    if (words.size() > 7 + axes) {
      const std::string& group = words.at(8 + axes);  // 'type_2'
      read.types.push_back(std::stoi(group.substr(group.find('_') + 1)));
    }
  }
  return read;
}

/// particle_input.dat of MFiX, as its Fortran counts lines.
inline ReadBack read_mfix(const std::filesystem::path& file, int dimension, double& density) {
  ReadBack read;
  const auto lines = lines_in(file);
  demand(lines.at(0) == "Version 2.0", "version");
  for (std::size_t k = 0; k < 34; ++k) demand(!words_in(lines.at(k)).empty(), "an empty line is not counted");
  const auto field = [&](std::size_t line, std::size_t k) { return words_in(lines.at(line)).at(k); };
  demand(std::stoi(field(18, 1)) == dimension, "dimension");
  const std::size_t count = std::stoul(field(19, 1));
  demand(field(23, 1) == "T", "coordinates are read");
  const bool typed = field(24, 1) == "T";
  demand(field(25, 1) == "T" && field(26, 1) == "F", "diameters are read, densities are not");
  density = number(field(26, 2));
  demand(lines.size() == 34 + count, "other count than said");
  for (std::size_t i = 34; i < lines.size(); ++i) {
    const auto words = words_in(lines[i]);
    const auto axes = static_cast<std::size_t>(dimension);
    demand(words.size() == axes + (typed ? 2 : 1), "columns: " + lines[i]);
    std::array<double, 3> center{};
    for (std::size_t k = 0; k < axes; ++k) center[k] = number(words[k]);
    read.add(center, number(words.back()) / 2);
    if (typed) read.types.push_back(std::stoi(words[axes]));
  }
  return read;
}

/// The spheres of a POV-Ray scene, in its left-handed frame.
inline ReadBack read_povray(const std::filesystem::path& file) {
  ReadBack read;
  for (const std::string& line : lines_in(file)) {
    if (!line.starts_with("sphere{")) continue;
    const auto words = words_in(line.substr(7), "<,> ");
    read.add({number(words[0]), number(words[1]), number(words[2])}, number(words[3]));
  }
  return read;
}

/// A .npy of doubles: its shape, and its numbers row by row.
struct Array {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};
inline Array read_npy(const std::filesystem::path& file) {
  const std::string bytes = text_of(file);
  demand(bytes.substr(0, 8) == std::string("\x93NUMPY\x01\0", 8), "magic");
  const std::size_t length =
      static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  demand((10 + length) % 64 == 0, "alignment");
  const std::string header = bytes.substr(10, length);
  demand(header.find("'descr': '<f8'") != header.npos, "type");
  demand(header.find("'fortran_order': False") != header.npos, "order");
  demand(header.back() == '\n', "end of the header");
  Array array;
  const std::size_t open = header.find('(');
  std::size_t count = 1;
  for (const std::string& word : words_in(header.substr(open + 1, header.find(')') - open - 1), ", ")) {
    array.shape.push_back(std::stoul(word));
    count *= array.shape.back();
  }
  demand(bytes.size() == 10 + length + 8 * count, "other length than said");
  array.values.resize(count);
  if (count > 0) std::memcpy(array.values.data(), bytes.data() + 10 + length, 8 * count);
  return array;
}

/// A GSD file of version 2 by the names of its chunks, each with its rows, columns, type and bytes.
struct GsdChunk {
  std::uint64_t rows;
  std::uint32_t columns;
  int type;
  std::string bytes;

  template <class T>
  std::vector<T> as() const {
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
};
inline std::map<std::string, GsdChunk> read_gsd(const std::filesystem::path& file) {
  const std::string bytes = text_of(file);
  const auto at = [&]<class T>(std::size_t offset, T value) {
    demand(offset + sizeof value <= bytes.size(), "the file ends too early");
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  };
  demand(at(0, std::uint64_t{}) == 0x65DF65DF65DF65DF, "magic");
  const auto index = at(8, std::uint64_t{}), entries = at(16, std::uint64_t{}),
             names = at(24, std::uint64_t{}), blocks = at(32, std::uint64_t{});
  demand(at(40, std::uint32_t{}) == 0x00010004 && at(44, std::uint32_t{}) == 0x00020000, "versions");
  demand(std::string(bytes.data() + 112) == "hoomd", "schema");
  std::vector<std::string> list;
  for (std::size_t p = names; p < names + 64 * blocks && bytes.at(p) != '\0'; p += list.back().size() + 1)
    list.emplace_back(bytes.data() + p);
  std::map<std::string, GsdChunk> chunks;
  std::uint64_t before = 0;
  bool ended = false;
  for (std::uint64_t k = 0; k < entries; ++k) {
    const std::size_t entry = index + 32 * k;
    const auto location = at(entry + 16, std::int64_t{});
    if (location == 0) {
      ended = true;
      break;
    }
    const auto id = at(entry + 28, std::uint16_t{});
    const auto rows = at(entry + 8, std::uint64_t{});
    const auto columns = at(entry + 24, std::uint32_t{});
    const int type = at(entry + 30, std::uint8_t{});
    const std::map<int, std::size_t> sizes = {{1, 1}, {3, 4}, {4, 8}, {9, 4}};
    demand(at(entry, std::uint64_t{}) == 0, "one frame");
    demand(k == 0 || id > before, "the index is sorted by names");
    before = id;
    const std::size_t length = rows * columns * sizes.at(type);
    demand(static_cast<std::size_t>(location) + length <= bytes.size(), "a chunk beyond the end");
    chunks[list.at(id)] = {rows, columns, type, bytes.substr(static_cast<std::size_t>(location), length)};
  }
  demand(ended, "no end of the index");
  return chunks;
}

}  // namespace bernal::testing::exports
