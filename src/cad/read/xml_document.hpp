#pragma once
#include <pugixml.hpp>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "cad/read/known_formats.hpp"

namespace bernal::cad {

/// An XML document in memory, in any encoding; only XML's own entities are expanded. Errors in it are thrown
/// as Error{bad_mesh} in one phrase that ends in the line.
///
/// Names do not depend on the document's prefixes: elements in the namespace of the root, and attributes
/// without a namespace, have their bare names ("vertex"); those in the requested namespaces have names such
/// as "{production}path". All others contain a colon and match no bare name.
class XmlDocument {
 public:
  /// A namespace, and its abbreviation in the names of its members.
  struct Namespace {
    std::string_view uri, name;
  };

  /// `name` is the document's name in errors, empty for a whole file. Memory: about six times the text.
  /// Throws if it is not well-formed.
  XmlDocument(std::string name, std::string text, std::initializer_list<Namespace> asked = {});

  pugi::xml_node root() const { return document_.document_element(); }
  /// The namespace of a prefix in the root; empty if there is none.
  std::string_view namespace_of(std::string_view prefix) const;
  /// Throws if a prefix is used but not declared.
  void require_namespaces() const;
  /// Throws if there are two.
  pugi::xml_node only_child(pugi::xml_node node, std::string_view name) const;
  /// A text as a finite number; `name()` is its name in errors: "x of vertex 7".
  template <class Name>
  double number(std::string_view text, pugi::xml_node at, const Name& name) const {
    if (const std::optional<double> value = finite_number(text)) return *value;
    refuse_number(text, at, name());
  }
  /// A text as the index of one of `count` vertices; `name()` is its context in errors: "triangle 7".
  template <class Name>
  std::uint32_t index(std::string_view text, std::size_t count, pugi::xml_node at, const Name& name) const {
    const std::optional<double> value = finite_number(text);
    if (value && *value >= 0 && *value < double(count) && *value == std::floor(*value))
      return static_cast<std::uint32_t>(*value);
    refuse_index(text, count, at, name());
  }
  /// "{what} (line 12 of 3D/3dmodel.model)"
  [[noreturn]] void refuse(pugi::xml_node at, const std::string& what) const;

 private:
  [[noreturn]] void refuse_number(std::string_view text, pugi::xml_node at, const std::string& what) const;
  [[noreturn]] void refuse_index(std::string_view text, std::size_t count, pugi::xml_node at,
                                 const std::string& what) const;
  [[noreturn]] void refuse_at(std::size_t offset, const std::string& what) const;

  class Names;
  std::string name_, text_;
  pugi::xml_document document_;
  pugi::xml_node undeclared_at_;  ///< the first with an undeclared prefix
  std::string undeclared_;        ///< the undeclared prefix
};

inline bool is_named(pugi::xml_node node, std::string_view name) { return name == node.name(); }

/// The first child or attribute of that name; empty if there is none.
pugi::xml_node child_of(pugi::xml_node node, std::string_view name);
std::string_view attribute_of(pugi::xml_node node, std::string_view name);

}  // namespace bernal::cad
