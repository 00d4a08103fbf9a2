"""Pages of the public headers, one each, of what Doxygen read there (XML): what an entry is, and
its words."""

import html
import os
import re
import xml.etree.ElementTree as ElementTree
from collections import defaultdict

KINDS = ("class", "struct", "union")
SIGNS = dict(ndash="–", mdash="—", zwj="", nonbreakablespace=" ", linebreak="\n", lsquo="‘",
    rsquo="’", ldquo="“",
             rdquo="”")


class Api:
    """`headers`: {file in the tree: (component, name of the page without ending)}."""

    def __init__(self, folder, root, headers):
        self.root, self.headers = root, headers
        self.entries = defaultdict(list)  # by file: (line, kind, element)
        self.files, self.places = {}, {}  # by file: its element; by id: (file, anchor)
        # The folder may have files of headers that are gone.
        for entry in ElementTree.parse(os.path.join(folder,
            "index.xml")).getroot().iter("compound"):
            if entry.get("kind") in ("file", "namespace", *KINDS):
                for compound in ElementTree.parse(os.path.join(folder,
                    entry.get("refid") + ".xml")).getroot():
                    self._take(compound)
        for entries in self.entries.values():
            entries.sort(key=lambda entry: entry[0])

    def _take(self, compound):
        kind = compound.get("kind")
        if kind == "file":
            path = self._file(compound)
            if path in self.headers:
                self.files[path] = compound
                self.places[compound.get("id")] = (path, "")
        if kind in KINDS:
            path = self._file(compound)
            if path not in self.headers or compound.get("prot") == "private":
                return
            name = compound.findtext("compoundname")
            self.places[compound.get("id")] = (path, anchor(name))
            for member in compound.iter("memberdef"):
                self.places[member.get("id")] = (path, anchor(name))
            self.entries[path].append((int(compound.find("location").get("line")), kind, compound))
        if kind in ("file", "namespace"):
            for member in compound.iter("memberdef"):
                path = self._file(member)
                if path in self.headers and member.get("id") not in self.places:
                    self.places[member.get("id")] = (path, anchor(member.findtext("name")))
                    line = int(member.find("location").get("line"))
                    self.entries[path].append((line, member.get("kind"), member))

    def _file(self, element):
        return os.path.relpath(os.path.join(self.root, element.find("location").get("file")),
            self.root)

    # -- pages

    def page(self, path):
        """Markdown of a header."""
        component, _ = self.headers[path]
        name = os.path.basename(path)
        folder = "" if component == "c" else component + "/"
        lines = [f"# {name}", "", f"`#include <animeme/{folder}{name}>`", ""]
        about = self.files[path]
        lines += self._words(about, path)
        named = None
        for _, kind, element in self.entries[path]:
            if kind in KINDS:
                lines += self._class(kind, element, path)
                named = None
                continue
            name = element.findtext("name")
            if name.startswith("@"):  # an enum without a name
                lines += [f"## Constants {{ #constants-{element.find('location').get('line')} }}",
                    ""]
            elif name != named:  # overloads share a heading
                lines += [f"## {_escape(name)} {{ #{anchor(name)} }}", ""]
            named = name
            lines += self._entry(element, path)
        return "\n".join(lines) + "\n"

    def first_words(self, path):
        """What a header is for, in a line."""
        about = self.files[path]
        for part in ("briefdescription", "detaileddescription"):
            blocks = self._blocks(about.find(part), None)
            if blocks:
                return re.split(r"(?<=[.:])\s", blocks[0])[0].rstrip(":")
        return ""

    def _class(self, kind, compound, path):
        name = compound.findtext("compoundname")
        short = re.sub(r"^animeme::(\w+::)?", "", name)
        lines = [f"## {_escape(short)} {{ #{anchor(name)} }}", "",
            *_code(_template(compound) + f"{kind} {name}")]
        lines += self._words(compound, path)
        members = [member for section in compound.iter("sectiondef") for member
            in section.iter("memberdef")]
        members = [member for member in members if member.get("prot") == "public"
            and member.get("kind") != "friend"]
        for member in sorted(members, key=lambda item: int(item.find("location").get("line"))):
            if member.get("kind") in ("variable", "typedef") and len(self._words(member, path)) < 3:
                lines += _item(_signature(member), self._words(member, path))
            else:
                lines += ["", *self._entry(member, path)]
        return lines + [""]

    def _entry(self, member, path):
        lines = _code(_signature(member)) + self._words(member, path)
        for value in member.findall("enumvalue"):
            lines += _item(value.findtext("name") + " " + _flat(value.find("initializer")),
                self._words(value, path))
        return lines + [""]

    # -- words

    def _words(self, element, path):
        parts = (element.find(part) for part in ("briefdescription", "detaileddescription"))
        return [line for part in parts for line in self._blocks(part, path)]

    def _blocks(self, description, path):
        """Markdown lines of a description, a blank one behind each block."""
        lines = []
        for child in description if description is not None else []:
            if child.tag == "para":
                lines += self._paragraph(child, path)
            elif child.tag == "sect1":
                lines += self._blocks(child, path)
        return lines

    def _paragraph(self, para, path):
        lines, text = [], para.text or ""

        def flush():
            nonlocal text
            if text.strip():
                lines.extend([" ".join(text.split()), ""])
            text = ""

        for child in para:
            if child.tag in ("itemizedlist", "orderedlist"):
                flush()
                for i, item in enumerate(child.findall("listitem"), 1):
                    mark = "-" if child.tag == "itemizedlist" else f"{i}."
                    words = "\n".join(self._blocks(item, path)).strip().replace("\n", "\n    ")
                    lines.append(f"{mark} {words}")
                lines.append("")
            elif child.tag in ("verbatim", "programlisting"):
                flush()
                lines += ["```", *"".join(child.itertext()).strip("\n").split("\n"), "```", ""]
            elif child.tag == "blockquote":
                flush()
                lines += ["> " + line for line in self._blocks(child, path)] + [""]
            else:
                text += self._inline(child, path)
            text += _escape(child.tail or "")
        flush()
        return lines

    def _inline(self, child, path):
        words = "".join(child.itertext())
        if child.tag == "computeroutput":
            return _inline_code(words)
        if child.tag == "ref":
            return self.link(child.get("refid"), words, path)
        if child.tag in SIGNS:
            return SIGNS[child.tag]
        return f"**{_escape(words)}**" if child.tag == "bold" else f"*{_escape(words)}*"

    def link(self, id_, words, path):
        """A link to an entry, where it has a place on a page."""
        place = self.places.get(id_)
        if path is None or place is None or place == (path, ""):
            return _escape(words)
        page = self.headers[place[0]][1] + ".md"
        here = os.path.dirname(self.headers[path][1])
        return f"[{_escape(words)}]({os.path.relpath(page, here)}{'#' + place[1] if place[1] else ''})"


def anchor(name):
    return re.sub(r"\W+", "-", name.removeprefix("animeme::")).strip("-").lower() or "operator"


def _flat(element):
    """Its text in a line; types without the spaces that Doxygen puts into them."""
    text = " ".join("".join(element.itertext()).split()) if element is not None else ""
    return re.sub(r"(?<=\w)< | >(?=[ ,>*&)]|$)", lambda match: match.group(0).strip(), text)


def _template(element):
    parameters = element.find("templateparamlist")
    if parameters is None:
        return ""
    parts = parameters.findall("param")
    names = [f"{_flat(one.find('type'))} {one.findtext('declname') or ''}".strip() for one in parts]
    return f"template <{', '.join(names)}>\n"


def _signature(member):
    """A declaration in a line, as it is in the header."""
    kind, name = member.get("kind"), member.findtext("name")
    type_, arguments, start = (_flat(member.find(part)) for part
        in ("type", "argsstring", "initializer"))
    if kind == "define":
        parameters = [one.findtext("defname") or "" for one in member.findall("param")]
        return f"#define {name}{'(' + ', '.join(parameters) + ')' if parameters else ''} {start}".strip()
    if kind == "enum":
        name = "" if name.startswith("@") else " " + name
        return f"enum{' class' if member.get('strong') == 'yes' else ''}{name}" + (f" : {type_}"
            if type_ else "")
    if kind == "typedef":
        return _flat(member.find("definition")) or f"using {name}"
    words = f"{type_} {name}{arguments}".strip()
    if member.get("static") == "yes" and not words.startswith("static"):
        words = "static " + words
    short = len(start) < 60 and "\n" not in start
    return _template(member) + words + (f" {start}" if kind == "variable" and start and short
        else "")


def _code(text):
    # A declaration beyond a line's width goes on below, a parameter a line.
    if len(text) > 90 and "(" in text:
        head, rest = text.split("(", 1)
        parts, depth, part = [], 0, ""
        for sign in rest:
            depth += {"(": 1, "<": 1, "{": 1, ")": -1, ">": -1, "}": -1}.get(sign, 0)
            part += sign
            if sign == "," and depth == 0:
                parts, part = parts + [part.strip()], ""
        text = head + "(\n    " + "\n    ".join(parts + [part.strip()])
    return ["```cpp", *text.split("\n"), "```", ""]


def _escape(text):
    return re.sub(r"([\\`*_\[\]<>#|])", r"\\\1", html.unescape(text)) if text else ""


def _item(code, words):
    """A line of a list."""
    words = " ".join(words).strip()
    return [f"- {_inline_code(code)}" + (f" — {words}" if words else "")]


def _inline_code(text):
    ticks = "``" if "`" in text else "`"
    return f"{ticks}{' '.join(text.split())}{ticks}"
