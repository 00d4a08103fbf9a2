"""The file of stubs, the module and its docstrings say the same."""
import ast
import inspect
import re

import pytest

import animeme
from conftest import SOURCE

STUBS = ast.parse((SOURCE / "tools/bindings/python/animeme/__init__.pyi").read_text())
# What Python or pybind11 adds to every class.
OWN = {"__doc__", "__module__", "__hash__", "__getstate__", "__setstate__", "__weakref__",
    "__annotations__"}
PLAIN = {"Error", "InputWarning", "Phone", "Position"}  # written in Python


def public(names):
    return {name for name in names if not name.startswith("_") or name == "__version__"}


def defined(body):
    """Names of a module or class of stubs with what stands for them: overloads and setters are
    lists."""
    found = {}
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found.setdefault(node.name, []).append(node)
        elif isinstance(node, ast.AnnAssign):
            found.setdefault(node.target.id, []).append(node)
    return found


MODULE = defined(STUBS.body)
CLASSES = sorted(name for name, (node, *_) in MODULE.items() if isinstance(node, ast.ClassDef))
FUNCTIONS = sorted(name for name, (node, *_) in MODULE.items() if isinstance(node, ast.FunctionDef))


def decorators(node):
    return {ast.unparse(d).split(".")[-1] for d in node.decorator_list}


def of_module(function):
    """The signature that pybind11 writes in front of a docstring, as a definition."""
    signature = function.__doc__.splitlines()[0]
    return ast.parse(f"def {signature}: ...").body[0]


def arguments(node):
    """Names, kinds and defaults, but for self."""
    a = node.args
    plain = [arg.arg for arg in a.posonlyargs + a.args]
    defaults = [ast.unparse(d) for d in a.defaults]
    named = [(k.arg, ast.unparse(d) if d else None) for k, d in zip(a.kwonlyargs, a.kw_defaults)]
    return [name for name in plain if name != "self"], defaults, named


def types_agree(ours, stub):
    """Whether a type that pybind11 tells is that of the stub. `object` says nothing."""
    if ours is None or stub is None:
        return ours is stub
    ours, stub = ast.unparse(ours), ast.unparse(stub)
    plain = {"object": None, "buffer": "_Buffer", "Iterator": None, "dict": "dict", "list": "list",
        "tuple": "tuple"}
    array = re.fullmatch(r"numpy\.ndarray\[(?:numpy\.)?(\w+)\]", ours)
    if array and stub == "ArrayLike":
        return True
    if array:
        return stub == f"NDArray[np.{array[1].replace('bool', 'bool_')}]"
    ours = re.sub(r"\bList\b", "list", ours.replace("animeme.", ""))
    if ours in plain:
        return plain[ours] is None or stub.split("[")[0] == plain[ours]
    if ours == "str":
        return stub == "str" or stub in ("_Preset", "_Method")
    return ours == stub or f"Optional[{ours}]" == stub


def check_function(name, function, nodes):
    node = nodes[-1]
    ours = of_module(function)
    assert arguments(ours) == arguments(node), name
    given = {a.arg: a.annotation for a in ours.args.args + ours.args.kwonlyargs if a.arg not
        in ("self", "other")}
    for arg in node.args.args + node.args.kwonlyargs:
        if arg.arg in given and len(nodes) == 1:
            assert types_agree(given[arg.arg], arg.annotation), (name, arg.arg)
    assert len(nodes) > 1 or types_agree(ours.returns, node.returns), name


def test_names_are_the_same():
    assert set(animeme.__all__) == public(MODULE) == public(CLASSES + FUNCTIONS) | {
        name for name, (node, *_) in MODULE.items() if isinstance(node, ast.AnnAssign) and name
        in animeme.__all__}
    missing = {name for name in public(vars(animeme)) if not inspect.ismodule(getattr(animeme,
        name))}
    assert missing == set(animeme.__all__)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_are_the_same(name):
    check_function(name, getattr(animeme, name), MODULE[name])


@pytest.mark.parametrize("name", [name for name in CLASSES if name not in PLAIN])
def test_classes_are_the_same(name):
    cls, stubs = getattr(animeme, name), defined(MODULE[name][0].body)
    members = {k: v for k, v in vars(cls).items() if k not in OWN}
    if type(members.get("__init__")).__name__ == "wrapper_descriptor":
        del members["__init__"]  # nobody makes one
    assert set(members) == set(stubs)
    for member, nodes in stubs.items():
        value = members[member]
        if isinstance(value, property):
            assert decorators(nodes[0]) == {"property"}, member
            assert (value.fset is not None) == (len(nodes) == 2 and "setter"
                in decorators(nodes[1])), member
            told = ast.parse("def f" + value.fget.__doc__.splitlines()[0] + ": ...").body[0]
            assert types_agree(told.returns, nodes[0].returns), member
        elif isinstance(value, staticmethod):
            assert decorators(nodes[0]) == {"staticmethod"}, member
            check_function(member, value.__func__, nodes)
        else:
            assert decorators(nodes[0]) <= {"overload"}, member
            check_function(member, value, nodes)


@pytest.mark.parametrize("name", sorted({"Phone", "Position"}))
def test_tuples_are_the_same(name):
    fields = {n.target.id: ast.literal_eval(n.value) for n in MODULE[name][0].body if n.value}
    assert getattr(animeme, name)._field_defaults == fields
    assert getattr(animeme, name)._fields == tuple(n.target.id for n in MODULE[name][0].body)


def text_of(function):
    """A docstring without its signature."""
    return (function.__doc__ or "").partition("\n")[2].strip()


def test_everything_is_described():
    bare = []
    for name in CLASSES:
        cls = getattr(animeme, name)
        if not (cls.__doc__ or "").strip():
            bare.append(name)
        for member, value in vars(cls).items() if name not in PLAIN else []:
            if member.startswith("__") and member != "__init__":
                continue
            value = value.__func__ if isinstance(value, staticmethod) else value
            text = value.__doc__ if isinstance(value, property) else text_of(value)
            if type(value).__name__ != "wrapper_descriptor" and not (text or "").strip():
                bare.append(f"{name}.{member}")
    bare += [name for name in FUNCTIONS if not text_of(getattr(animeme, name))]
    assert bare == [] and animeme.__doc__.count("\n") > 5


def test_arguments_are_described():
    """Each argument is named in the words about it."""
    bare = []
    for owner in [animeme, *(getattr(animeme, name) for name in CLASSES if name not in PLAIN)]:
        for member, value in vars(owner).items():
            value = value.__func__ if isinstance(value, staticmethod) else value
            if type(value).__name__ not in ("instancemethod", "builtin_function_or_method"):
                continue
            if member.startswith("__") and member != "__init__":
                continue
            names, _, named = arguments(of_module(value))
            for name in names + [k for k, _ in named]:
                if not re.search(rf"\b{name}\b", text_of(value)) and len(names + named) > 1:
                    bare.append(f"{owner.__name__}.{member}: {name}")
    assert bare == []


def test_arrays_are_described_with_shape_and_type():
    bare = []
    for name in CLASSES:
        for member, value in vars(getattr(animeme, name)).items():
            if not isinstance(value, property):
                continue
            (node, *_) = defined(MODULE[name][0].body)[member]
            array = re.fullmatch(r"(?:Optional\[)?NDArray\[np\.(\w+?)_?\]\]?",
                ast.unparse(node.returns))
            if array and not re.match(rf"{array[1]} \([^)]+\): ", value.__doc__):
                bare.append(f"{name}.{member}")
    assert bare == []


def test_they_are_of_the_package():
    for name in CLASSES:
        assert getattr(animeme, name).__module__ == "animeme"
        assert getattr(animeme, name).__name__ == name
    assert "_animeme" not in "".join(getattr(animeme, name).__doc__ for name in FUNCTIONS)
