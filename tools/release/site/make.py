#!/usr/bin/env python3
"""make.py SOURCE BUILD PROGRAM: the site, BUILD/site, of the project's own pages, its headers and
its program.

BUILD/xml is what Doxygen read in the headers, BUILD/pages/headers.txt a table of them:
component|header. Pages are collected in BUILD/pages/all for mkdocs.
"""

import os
import re
import shutil
import subprocess
import sys

import yaml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from api import Api  # noqa: E402

TOPS = ("fap", "codec", "dam", "conformance", "tools")
PICTURES = (".png", ".jpg", ".svg", ".webp")
# What of the pages is where; all others are rooms.
TUTORIALS = ("tools/cookbook.md", "dam/tutorial.md", "tools/bindings/blender/README.md",
    "tools/bindings/c/README.md", "tools/bindings/python/README.md",
             "tools/bindings/npm/README.md", "tools/bindings/agents/README.md",
             "tools/release/samples/README.md", "tools/bindings/examples/README.md",
             "tools/characters/trackers/README.md",
             "tools/app/cluster/README.md")
FORMATS = ("codec/bitstream.md", "codec/standards.md", "fap/semantics.md", "fap/text_format.md",
    "tools/formats/exchange/README.md",
           "tools/formats/media/containers.md", "dam/script/phoneme_scripts.md",
           "tools/formats/scripts/README.md",
           "tools/view/gltf/README.md", "tools/view/gltf/avatars.md", "fap/xml/README.md",
           "fap/head/face_models.md", "fap/head/rig.md",
           "conformance/README.md")


def pages_of(source):
    """The project's pages, relative to it."""
    found = ["README.md", "HACKING.md", "CHANGELOG.md"]
    for top in TOPS:
        for folder, folders, names in os.walk(os.path.join(source, top)):
            folders[:] = sorted(one for one in folders if one not
                in ("node_modules", "cases", "build"))
            inside = os.path.relpath(folder, source)
            found += [os.path.join(inside, name) for name in sorted(names) if name.endswith(".md")]
    return found


class Stage:
    def __init__(self, source, pages, headers, out):
        self.source, self.pages, self.headers, self.out = source, set(pages), headers, out

    def write(self, page, text):
        path = os.path.join(self.out, page)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def take(self, page):
        """A page as it is, but for links: pictures come along, headers are pages here, other files
        are names."""
        with open(os.path.join(self.source, page), encoding="utf-8") as file:
            text = file.read()
        here = os.path.dirname(page)

        def link(match):
            bang, words, target, place = match.groups()
            if re.match(r"\w+:", target) or not target:
                return match.group(0)
            to = os.path.normpath(os.path.join(here, target))
            if to.endswith(PICTURES):
                os.makedirs(os.path.dirname(os.path.join(self.out, to)), exist_ok=True)
                shutil.copyfile(os.path.join(self.source, to), os.path.join(self.out, to))
                return match.group(0)
            if to in self.headers:
                return f"{bang}[{words}]({os.path.relpath(self.headers[to][1] + '.md', here or '.')}{place or ''})"
            if os.path.join(to, "README.md") in self.pages:
                return f"{bang}[{words}]({os.path.relpath(os.path.join(to, 'README.md'), here or '.')}{place or ''})"
            return match.group(0) if to in self.pages else words

        fenced = re.split(r"(^```.*?^```$|^    .*?$)", text, flags=re.S | re.M)
        for i in range(0, len(fenced), 2):
            fenced[i] = re.sub(r"(!?)\[([^\]]*)\]\(([^)#\s]*)(#[^)\s]*)?\)", link, fenced[i])
        self.write(page, "".join(fenced))


def title_of(source, page):
    with open(os.path.join(source, page), encoding="utf-8") as file:
        first = next((line for line in file if line.startswith("# ")), page)
    return re.sub(r"[`*]", "", first[2:].strip())


def say(program, *words):
    wide = {**os.environ, "COLUMNS": "96"}  # that a page has room for
    return subprocess.run([program, *words], check=True, capture_output=True, text=True,
        env=wide).stdout


def command_pages(stage, program):
    """What each command says of itself."""
    table = re.search(r"Commands:\n(.*?)\n\n", say(program, "--help"), re.S).group(1)
    commands = re.findall(r"^  (\w+) +(.*)$", re.sub(r"\n   +", " ", table), re.M)
    text = "# Commands\n\nWhat `animeme COMMAND --help` says.\n\n| command | |\n|---|---|\n"
    nav = ["commands/index.md"]
    for name, about in commands:
        text += f"| [`{name}`]({name}.md) | {about} |\n"
        words = say(program, name, "--help").rstrip()
        stage.write(f"commands/{name}.md", f"# animeme {name}\n\n```text\n{words}\n```\n")
        nav.append({name: f"commands/{name}.md"})
    stage.write("commands/index.md", text)
    return nav


def api_pages(stage, xml):
    """C and C++: a page a header, a list of those."""
    api = Api(xml, stage.source, stage.headers)
    components = {}
    for path in sorted(stage.headers, key=lambda header: stage.headers[header]):
        if path in api.files:
            component, page = stage.headers[path]
            stage.write(page + ".md", api.page(path))
            components.setdefault(component, []).append(path)
    text = "# C++\n\nThe public headers, by the components of `find_package(animeme COMPONENTS ...)`.\n"
    nav = ["api/cpp/index.md"]
    for component, paths in components.items():
        if component == "c":
            continue
        text += f"\n## {component}\n\n| header | |\n|---|---|\n"
        for path in paths:
            page = os.path.relpath(stage.headers[path][1], "api/cpp") + ".md"
            text += f"| [`{os.path.basename(path)}`]({page}) | {api.first_words(path)} |\n"
        entries = [{os.path.basename(path): stage.headers[path][1] + ".md"} for path in paths]
        nav.append({f"animeme::{component}": entries})
    stage.write("api/cpp/index.md", text)
    return nav


def listing(stage, title, pattern, language, readme, page):
    """A page of declarations as they are, for languages whose stubs are their manual; nothing
    without their room."""
    folder = os.path.join(stage.source, os.path.dirname(readme))
    files = []
    for where, folders, names in os.walk(folder):
        folders[:] = sorted(one for one in folders if one not in ("node_modules", "build", "dist"))
        files += [os.path.join(where, name) for name in sorted(names) if name.endswith(pattern)]
    if readme not in stage.pages:
        return []
    text = f"# {title}\n\nHow to install and use it: [{os.path.dirname(readme)}](../{readme}).\n"
    for path in files:
        with open(path, encoding="utf-8") as file:
            text += f"\n## `{os.path.basename(path)}`\n\n```{language}\n{file.read().rstrip()}\n```\n"
    stage.write(page, text)
    return [{title: page}]


def demo_page(stage, program):
    """A sentence, spoken by the program onto three heads; without a voice, from a script of the
    project's."""
    clip, page = os.path.join(stage.out, "..", "demo.mp4"), os.path.join(stage.out, "demo",
        "talking_head.html")
    os.makedirs(os.path.dirname(page), exist_ok=True)
    text = "Hello world! My mouth moves by numbers, and a few thousand bits a second are enough."
    script = os.path.join(stage.source, "tests/data/grid_s1_sample/phonemes/prac8p.tsv")
    try:
        say(program, "-q", "speak", "--text", text, "-o", clip)
    except subprocess.CalledProcessError:
        clip = clip[:-4] + ".fba"
        say(program, "-q", "speak", "--script", script, "-o", clip)
    say(program, "-q", "view", clip, "--head", "woman,man,child", "-o", page)
    stage.write("demo/index.md", f"""# A talking head

This page was made by two commands, when the site was. Press Space, or turn the head with the mouse.

    animeme speak --text "{text}" -o hello.mp4
    animeme view hello.mp4 --head woman,man,child -o talking_head.html

<iframe class="demo" src="talking_head.html" title="A talking head"></iframe>

[The page alone](talking_head.html), one file that works without a network.
""")


def main():
    source, build, program = sys.argv[1:]
    out = os.path.join(build, "pages")
    pages = pages_of(source)
    headers = {}
    with open(os.path.join(out, "headers.txt"), encoding="utf-8") as file:
        for line in file.read().split():
            component, header = line.split("|")
            base = os.path.basename(header).removesuffix(".h")
            headers[header] = (component,
                f"api/{'c' if component == 'c' else 'cpp/' + component}/{base}")
    stage = Stage(source, pages, headers, os.path.join(out, "all"))
    shutil.rmtree(stage.out, ignore_errors=True)
    for page in pages:
        stage.take(page)
    here = os.path.dirname(os.path.abspath(__file__))
    for name in ("style.css", "site.js"):
        shutil.copyfile(os.path.join(here, name), os.path.join(stage.out, name))
    demo_page(stage, program)
    commands = command_pages(stage, program)
    cpp = api_pages(stage, os.path.join(build, "xml"))
    named = lambda chosen: [{title_of(source, page): page} for page in chosen if page
        in stage.pages]  # noqa: E731
    modules = [page for page in pages if page not in TUTORIALS + FORMATS and os.path.dirname(page)]
    by_top = [{top: named([page for page in modules if page.split("/")[0] == top])} for top in TOPS]
    nav = [
        {"Start": [{"Animeme": "README.md"}, {"Working on it": "HACKING.md"},
        {"Changes": "CHANGELOG.md"}]},
        {"Tutorials": named(TUTORIALS)}, {"Formats": named(FORMATS)}, {"Commands": commands},
        {"Demo": "demo/index.md"},
        {"API": [{"C": "api/c/animeme.md"}, {"C++": cpp},
                 *listing(stage, "Python", ".pyi", "python", "tools/bindings/python/README.md",
                 "api/python.md"),
                 *listing(stage, "JavaScript", ".d.ts", "typescript",
                 "tools/bindings/npm/README.md", "api/javascript.md")]},
        {"Modules": by_top},
    ]
    with open(os.path.join(here, "mkdocs.yml"), encoding="utf-8") as file:
        settings = yaml.safe_load(file)
    settings.update(hooks=[os.path.join(here, "hooks.py")], nav=nav, docs_dir=stage.out,
                    site_dir=os.path.join(build, "site"))
    settings_file = os.path.join(out, "mkdocs.yml")
    with open(settings_file, "w", encoding="utf-8") as file:
        yaml.safe_dump(settings, file, allow_unicode=True, sort_keys=False)
    return subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--clean", "-f",
        settings_file]).returncode


sys.exit(main())
