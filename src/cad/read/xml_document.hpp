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

/// An XML document in memory, whatever its encoding; entities are those of XML, never a document's own. What
/// is wrong with it or in it is refused as Error{bad_mesh} in one phrase that ends in the line.
///
/// Whatever prefixes it writes: elements in the namespace of its root have their bare names ("vertex"), and
/// so have attributes without a namespace; those in the namespaces that are asked for have names such as
/// "{production}path". All others have a colon in theirs, and are found by no bare name.
class XmlDocument {
 public:
  /// A namespace, and what stands for it in the names of what is in it.
  struct Namespace {
    std::string_view uri, name;
  };

  /// `name` is what phrases call it; nothing, where it is the whole file. Cost: about six times the text in
  /// memory. Throws where it is not well-formed.
  XmlDocument(std::string name, std::string text, std::initializer_list<Namespace> asked = {});

  pugi::xml_node root() const { return document_.document_element(); }
  /// The namespace that a prefix stands for in the root; empty where there is none.
  std::string_view namespace_of(std::string_view prefix) const;
  /// Throws where a prefix that is used is declared nowhere.
  void require_namespaces() const;
  /// Throws where there are two.
  pugi::xml_node only_child(pugi::xml_node node, std::string_view name) const;
  /// Text as a finite number; `name()` is what to call it: "x of vertex 7".
  template <class Name>
  double number(std::string_view text, pugi::xml_node at, const Name& name) const {
    if (const std::optional<double> value = finite_number(text)) return *value;
    refuse_number(text, at, name());
  }
  /// Text as the index of one of so many vertices; `name()` is what it stands in: "triangle 7".
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
  pugi::xml_node undeclared_at_;  ///< the first that has a prefix which is declared nowhere
  std::string undeclared_;        ///< that prefix
};

inline bool is_named(pugi::xml_node node, std::string_view name) { return name == node.name(); }

/// The first child or attribute of that name; an empty one where there is none.
pugi::xml_node child_of(pugi::xml_node node, std::string_view name);
std::string_view attribute_of(pugi::xml_node node, std::string_view name);

}  // namespace bernal::cad
