#include "bernal/result/write_contacts.hpp"

#include <charconv>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "files/input_file.hpp"
#include "files/npy_file.hpp"
#include "files/output_file.hpp"
#include "files/staged_folder.hpp"
#include "result/result_folder.hpp"
#include "result/write_csv.hpp"
#include "result/write_vtp.hpp"

namespace bernal {
namespace {

std::string heading_of_contacts(int dimension) {
  std::vector<std::string> columns = csv_columns(dimension), normal;
  columns.pop_back();  // the radius
  for (const std::string& axis : columns) normal.push_back("n" + (dimension == 3 ? axis : axis.substr(1)));
  return fmt::format("i,j,gap,{},{}", fmt::join(normal, ","), fmt::join(columns, ","));
}

/// Calls visit(value) for the numbers of a row behind i and j.
template <class Visit>
void visit_row(const ContactList& contacts, std::size_t c, const Visit& visit) {
  visit(contacts.gap[c]);
  for (const auto* columns : {&contacts.normal, &contacts.place})
    for (const std::vector<double>& column : *columns) visit(column[c]);
}

void write_contacts_csv(OutputFile& out, const ContactList& contacts, std::string_view unit) {
  constexpr std::size_t longest_number = 32;
  const std::size_t columns = 3 + contacts.normal.size() + contacts.place.size();
  out.append(
      fmt::format("# unit: {}\n{}\n", unit, heading_of_contacts(static_cast<int>(contacts.normal.size()))));
  std::vector<char> line(columns * longest_number);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    char* end = line.data();
    const auto add = [&](auto value) {
      end = std::to_chars(end, line.data() + line.size(), value).ptr;
      *end++ = ',';
    };
    add(contacts.i[c]);
    add(contacts.j[c]);
    visit_row(contacts, c, add);
    end[-1] = '\n';
    out.append({line.data(), static_cast<std::size_t>(end - line.data())});
  }
}

void write_contacts_npy(OutputFile& out, const ContactList& contacts) {
  out.append(npy_header(contacts.size(), 3 + contacts.normal.size() + contacts.place.size()));
  std::vector<double> row;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    row = {static_cast<double>(contacts.i[c]), static_cast<double>(contacts.j[c])};
    visit_row(contacts, c, [&](double value) { row.push_back(value); });
    out.append({reinterpret_cast<const char*>(row.data()), row.size() * sizeof(double)});
  }
}

std::string beginning_of(const std::filesystem::path& file) {
  InputFile in(file);
  std::string text(400, ' ');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  return text;
}

bool is_contacts_file(const std::filesystem::path& file, int dimension) {
  const std::string text = beginning_of(file);
  if (file.extension() == ".vtp") return text.find(contacts_in_vtp) != text.npos;
  if (file.extension() == ".npy")
    return text.starts_with(npy_magic) && text.find(fmt::format(", {})", 3 + 2 * dimension)) != text.npos;
  return text.starts_with("# unit: ") && text.find("\n" + heading_of_contacts(dimension)) != text.npos;
}

}  // namespace

void check_contacts_file(const std::filesystem::path& file, int dimension) {
  const std::string ending = file.extension().string();
  if (ending != ".csv" && ending != ".npy" && ending != ".vtp")
    throw Error(ErrorCode::bad_argument,
                "contacts are written as .csv, .npy or .vtp: let the name end in one of these",
                {file.string()});
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  if (manifest_of(folder).contains(file.filename().string()))
    throw Error(ErrorCode::cannot_write, "belongs to the result there; give the contacts another name",
                {file.string()});
  std::error_code unknown;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, unknown)) &&
      !(std::filesystem::is_regular_file(file, unknown) && is_contacts_file(file, dimension)))
    throw Error(ErrorCode::cannot_write, "holds no contacts; nothing is written in its place",
                {file.string()});
}

void write_contacts(const Packing& packing, const ContactList& contacts, const std::filesystem::path& file) {
  check_contacts_file(file, packing.spheres.dimension());
  StagedFolder staged(file.parent_path().empty() ? "." : file.parent_path());
  OutputFile out(staged.add(file.filename().string()));
  const std::string_view unit = name_of(packing.scene.unit);
  if (file.extension() == ".vtp")
    write_contacts_vtp(out, contacts, packing.spheres, unit);
  else if (file.extension() == ".npy")
    write_contacts_npy(out, contacts);
  else
    write_contacts_csv(out, contacts, unit);
  out.close();
  staged.publish();
}

}  // namespace bernal
