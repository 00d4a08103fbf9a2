// The scene graph of an XMT-A text.
#pragma once

#include <map>
#include <set>

#include "fap/head/detail/scene.h"
#include "fap/xml/detail/document.h"

namespace animeme::head::detail {

/// Makes scene nodes of XML elements when they are asked for. Elements that begin with a capital
/// are nodes, others are fields with nodes in them; attributes are fields with numbers or words.
/// USE may stand before its DEF. The document has to outlive it.
class XmtScene {
 public:
  explicit XmtScene(const XmlElement& root) { collect(root); }

  /// The node of an element; the same one each time. Null for USE of a name that nobody has.
  /// Errors: see set_field(); syntax (a node that is within itself).
  Result<SceneNodePtr> node(const XmlElement& element);
  /// The node in a field of an element: the first one. Null if there is none.
  Result<SceneNodePtr> node_in(const XmlElement& element, std::string_view field);
  /// The element that has the name of a USE, or the element itself.
  const XmlElement* resolved(const XmlElement& element) const;
  /// Names that USE has and DEF has not, in the order of their letters.
  const std::set<std::string>& missing() const { return missing_; }

 private:
  void collect(const XmlElement& element);
  Result<void> fill(SceneNode& node, const XmlElement& element);
  Result<void> fill_attribute(SceneNode& node, const XmlElement& element,
                              const XmlElement::Attribute& attribute);
  Result<void> add_child(SceneNode& node, std::string_view field, const XmlElement& child);

  std::map<std::string, const XmlElement*, std::less<>> defs_;
  std::map<const XmlElement*, SceneNodePtr> made_;
  std::set<const XmlElement*> open_;
  std::set<std::string> missing_;
  int depth_ = 0;
};

/// True if an element is a node, false if it is a field.
bool is_node(const XmlElement& element);

/// The first element of a name in the order of the text, the root included; nothing if there is
/// none.
const XmlElement* find_element(const XmlElement& root, std::string_view name);

}  // namespace animeme::head::detail
