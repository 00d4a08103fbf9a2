#!/bin/sh
# The recipes of packages are true to the tree, without building any: one version everywhere, every
# installed file in one Debian package, the names of the symbols file, scripts, YAML and JSON that
# parse, a port whose options exist.
#   recipes.sh SOURCE_DIR PREFIX LIBDIR VERSION CMAKE
# What is not here to check with (python3-yaml, ruby, dpkg-dev) is left out, and said.
set -eu
tree=$1 prefix=$2 libdir=$3 version=$4 cmake=$5
packaging=$tree/tools/release/packaging debian=$tree/tools/release/packaging/debian
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "$1"
  exit 1
}

# One version.
same() {
  [ "$2" = "$version" ] || fail "$1 says version $2, CMakeLists.txt $version"
}
same debian/changelog "$(sed -n '1s/.*(\(.*\)).*/\1/p' "$debian/changelog")"
same vcpkg.json "$(sed -n 's/.*"version": "\(.*\)".*/\1/p' "$packaging/vcpkg/animeme/vcpkg.json")"
same animeme.rb "$(sed -n 's/^  version "\(.*\)"/\1/p' "$packaging/homebrew/animeme.rb")"

# The symbols file has the names that libanimeme shows, and no others.
sed -n 's/^ \(animeme_[a-z0-9_]*\)@ANIMEME_0 .*/\1/p' "$debian/libanimeme0.symbols" |
  diff "$tree/tests/bindings/c/exported.txt" - ||
  fail "libanimeme0.symbols and tests/bindings/c/exported.txt differ"
sed -n 's/.*@ANIMEME_0 //p' "$debian/libanimeme0.symbols" | sort -uV | tail -1 >"$work/newest"
printf '%s\n%s\n' "$(cat "$work/newest")" "$version" | sort -VC ||
  fail "a symbol is newer than $version"

# Every package of debian/control has its list, every list its package, and every installed file one
# of them. Debian has other folders for its libraries, its module of Python and completions of zsh.
sed -n 's/^Package: //p' "$debian/control" | sort >"$work/packages"
for list in "$debian"/*.install; do basename "$list" .install; done | sort |
  diff "$work/packages" - ||
  fail "debian/control has other packages than debian/*.install"
(cd "$prefix" && find . \( -type f -o -type l \) |
  sed "s|^\./$libdir/|usr/lib/triplet/|; s|^\./|usr/|; s|^usr/lib/triplet/python|usr/lib/python|
    s|^usr/lib/python3\.[0-9]*/|usr/lib/python3/|") >"$work/files"
grep -q . "$work/files" || fail "nothing is installed in $prefix"
while read -r file; do
  takers=''
  for list in "$debian"/*.install; do
    while read -r pattern _; do
      # shellcheck disable=SC2254  # patterns are meant
      case $file in $pattern | $pattern/*) takers="$takers $(basename "$list" .install)" ;; esac
    done <"$list"
  done
  [ "$(echo "$takers" | wc -w)" = 1 ] || fail "$file is in ${takers:-no package}"
done <"$work/files"

# Scripts parse; those that debian/tests/control names are there, and no others but that for roots
# without recommended packages.
for script in "$packaging"/*.sh "$debian"/tests/[a-z]*; do
  case $(basename "$script") in control) continue ;; esac
  [ -x "$script" ] || fail "$script cannot be run"
  case $(head -1 "$script") in *bash) bash -n "$script" ;; *) sh -n "$script" ;; esac
done
sed -n 's/^Tests: //p' "$debian/tests/control" | tr -d , | xargs -n1 | sort >"$work/named"
find "$debian/tests" -type f ! -name control ! -name without_recommends -printf '%f\n' | sort |
  diff "$work/named" - ||
  fail "debian/tests/control names others"
if command -v dpkg-parsechangelog >/dev/null; then
  dpkg-parsechangelog -l "$debian/changelog" >/dev/null
  mkdir "$work/debian"
  cp "$debian/control" "$work/debian"
  (cd "$work" && dpkg-checkbuilddeps 2>&1 | grep -v 'Unmet build dep' | grep .) &&
    fail "debian/control does not parse"
  make -s -n -C "$tree" -f "$debian/rules" override_dh_auto_configure >/dev/null ||
    fail "debian/rules does not parse"
else
  echo "dpkg-dev is missing: changelog and rules are not parsed"
fi

# Python's and Ruby's own parsers; what GitHub, vcpkg and Homebrew make of them is seen there.
if python3 -c 'import yaml' 2>/dev/null; then
  python3 - "$tree" <<'PYTHON'
import glob, json, os, re, sys, yaml
tree = sys.argv[1]
for path in glob.glob(tree + "/.github/workflows/*.yml"):
    flow = yaml.safe_load(open(path))
    # "on" is true to YAML 1.1.
    assert {"name", True, "permissions", "jobs"} <= set(flow), path
    for name, job in flow["jobs"].items():
        assert "runs-on" in job and "timeout-minutes" in job, (path, name)
        assert all(("run" in step) != ("uses" in step) for step in job["steps"]), (path, name)
        assert all(need in flow["jobs"] for need in job.get("needs", [])), (path, name)
        for step in job["steps"]:
            # What is run of the tree is there, and knows the mode.
            for script, mode in re.findall(r"(?:^|\s)((?:tests|tools)/[\w/]+\.sh) ?(\S*)", step.get("run", "")):
                assert os.access(os.path.join(tree, script), os.X_OK), (path, script)
json.load(open(tree + "/tools/release/packaging/vcpkg/animeme/vcpkg.json"))
PYTHON
else
  echo "python3-yaml is missing: workflows are not parsed"
fi
if command -v ruby >/dev/null; then
  ruby -c "$packaging/homebrew/animeme.rb" >/dev/null
else
  echo "ruby is missing: the formula is not parsed"
fi
# Options that the recipes give to CMake are those of the tree.
cat "$packaging"/homebrew/*.rb "$packaging"/vcpkg/animeme/portfile.cmake "$debian/rules" |
  grep -o 'ANIMEME_[A-Z]*_[A-Z0-9]*' | grep -v TARBALL | sort -u | while read -r option; do
  grep -rqE "option\\($option " "$tree/CMakeLists.txt" "$tree"/tools/*/*/CMakeLists.txt ||
    echo "$option" >>"$work/unknown"
done
# Python's room brings its option with it.
[ -d "$tree/tools/bindings/python" ] ||
  sed -i /ANIMEME_BUILD_PYTHON/d "$work/unknown" 2>/dev/null || true
[ ! -s "$work/unknown" ] || fail "no options of CMake: $(cat "$work/unknown")"

# The port with vcpkg's functions played by others: it configures the codec and the models.
"$cmake" -DTREE="$tree" -DWORK="$work/port" -P "$(dirname "$0")/vcpkg_port.cmake" >"$work/log" \
  2>&1 ||
  { cat "$work/log"; exit 1; }
echo "$(wc -l <"$work/files") files in $(wc -l <"$work/packages") packages"
