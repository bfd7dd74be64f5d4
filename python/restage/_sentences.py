# SPDX-License-Identifier: Apache-2.0
"""Errors about wrong arguments in one sentence. nanobind lists all overloads' signatures; here each function of the
module instead reports which argument was wrong, what it is and what it should be."""
import ast
import difflib
import functools
import inspect
import numbers
import re

_MARK = "incompatible function arguments"
_SKIP = ("__init__", "__new__", "__eq__", "__ne__", "__hash__", "__repr__", "__str__", "__len__", "__iter__", "__enter__", "__exit__",
         "__getstate__", "__setstate__")


def _number(value):
    return isinstance(value, numbers.Real) or hasattr(value, "__float__") and not isinstance(value, str)


def _whole(value):
    return isinstance(value, numbers.Integral) or hasattr(value, "__index__")


def _row(value, count, fits):
    try:
        return not isinstance(value, str) and len(value) == count and all(fits(v) for v in value)
    except TypeError:
        return False


def _all(value, fits):
    try:
        return not isinstance(value, str) and all(fits(v) for v in value)
    except TypeError:
        return False


# For each annotation: its name in messages, and whether a value fits. The module's types are looked up in the module.
_KINDS = {
    "float": ("a number", _number),
    "int": ("a whole number", _whole),
    "str": ("a str", lambda v: isinstance(v, str)),
    "bool": ("True or False", lambda v: isinstance(v, bool)),
    "None": ("None", lambda v: v is None),
    "os.PathLike": ("a path", lambda v: hasattr(v, "__fspath__")),
    "numpy.typing.ArrayLike": ("three numbers", lambda v: _row(v, 3, _number)),
    "tuple[int, int]": ("two whole numbers", lambda v: _row(v, 2, _whole)),
    "collections.abc.Sequence[float]": ("four numbers", lambda v: _row(v, 4, _number)),
    "collections.abc.Callable": ("a function", callable),
}


def _literal(value):
    try:
        ast.literal_eval(repr(value))
    except (SyntaxError, ValueError):
        return "..."
    return repr(value)


def _text(annotation):
    return ast.unparse(annotation).replace("restage._core.", "") if annotation else inspect.Parameter.empty


class _Signature:
    """One overload, parsed from nanobind's signature text."""

    def __init__(self, overload):
        text, _, defaults = overload
        for i, default in enumerate(defaults or ()):  # \0, \1, ... replace them
            text = re.sub(rf"\\{i}\b", lambda _: _literal(default), text)
        text = re.sub(r"\bndarray\[.*?\]", "numpy.ndarray", text)  # nanobind's own words for arrays
        name = "" if text.startswith("def (") else None
        node = ast.parse(text.replace("def (", "def _(", 1) + ": ...").body[0]
        self.name = node.name if name is None else name
        spec = node.args
        named = spec.posonlyargs + spec.args
        defaults = [inspect.Parameter.empty] * (len(named) - len(spec.defaults)) + spec.defaults
        self.parameters = []
        for i, (arg, default) in enumerate(zip(named, defaults)):
            kind = inspect.Parameter.POSITIONAL_ONLY if i < len(spec.posonlyargs) else inspect.Parameter.POSITIONAL_OR_KEYWORD
            self._add(arg, kind, default)
        if spec.vararg:
            self._add(spec.vararg, inspect.Parameter.VAR_POSITIONAL)
        for arg, default in zip(spec.kwonlyargs, spec.kw_defaults):
            self._add(arg, inspect.Parameter.KEYWORD_ONLY, inspect.Parameter.empty if default is None else default)
        if spec.kwarg:
            self._add(spec.kwarg, inspect.Parameter.VAR_KEYWORD)
        self.python = inspect.Signature(self.parameters, return_annotation=_text(node.returns))

    def _add(self, arg, kind, default=inspect.Parameter.empty):
        if default is not inspect.Parameter.empty:
            default = ast.literal_eval(default)
        self.parameters.append(inspect.Parameter(arg.arg, kind, default=default, annotation=_text(arg.annotation)))


def _alternatives(annotation):
    """The parts of "A | B[C | D]", A and B[C | D]."""
    parts, depth, start = [], 0, 0
    for i, letter in enumerate(annotation):
        depth += (letter == "[") - (letter == "]")
        if letter == "|" and depth == 0:
            parts.append(annotation[start:i].strip())
            start = i + 1
    return parts + [annotation[start:].strip()]


def _kind(part, module):
    known = _KINDS.get(part) or _KINDS.get(part.split("[")[0])
    if known:
        return known
    inner = part.partition("[")[2].removesuffix("]")
    if inner and part.startswith("collections.abc.") and hasattr(module, inner):
        return f"a list of {inner}s", lambda v: _all(v, lambda one: isinstance(one, getattr(module, inner)))
    named = getattr(module, part, None)
    if isinstance(named, type):
        return f"{'an' if part[0] in 'AEIOU' else 'a'} {part}", lambda v: isinstance(v, named)
    return part, lambda v: True  # unknown: accept


def _shown(value):
    text = repr(value)
    return f"{text if len(text) <= 40 else text[:37] + '...'} ({type(value).__name__})"


def _wrong(annotation, value, module):
    """What should replace this value, or None if it fits."""
    if annotation is inspect.Parameter.empty or annotation in ("object", "typing.Any"):
        return None
    parts = _alternatives(annotation)
    kinds = [_kind(part, module) for part in parts]
    if any(fits(value) for _, fits in kinds):
        if "int" in parts and _whole(value) and not isinstance(value, bool) and not 0 <= int(value) < 2**31:
            return "a whole number from 0 to 2147483647"
        return None
    words = ["a path" if part == "str" and "os.PathLike" in parts else words for part, (words, _) in zip(parts, kinds)]
    words = list(dict.fromkeys(words))
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " or " + words[-1]


def _complaint(signature, label, method, args, kwargs, module):
    parameters = signature.parameters[1:] if method else signature.parameters
    args = args[1:] if method else args
    positional = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    names = [p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    kinds = {p.kind for p in parameters}
    if len(args) > len(positional) and inspect.Parameter.VAR_POSITIONAL not in kinds:
        most = len(positional)
        return f"{label} takes {most or 'no'} argument{'s' * (most != 1)}, not {len(args)}"
    values = {p.name: value for p, value in zip(positional, args)}
    for name, value in kwargs.items():
        if name not in names and inspect.Parameter.VAR_KEYWORD in kinds:
            continue
        if name not in names:
            near = difflib.get_close_matches(name, names, 1)
            hint = f'did you mean "{near[0]}"?' if near else f"there are {', '.join(names)}" if names else "it has none"
            return f'{label} has no argument "{name}"; {hint}'
        if name in values:
            return f'{label} got "{name}" twice'
        values[name] = value
    for p in parameters:
        if p.kind in (p.VAR_POSITIONAL, p.VAR_KEYWORD):
            continue
        if p.name not in values:
            if p.default is p.empty:
                return f'{label} needs "{p.name}"'
            continue
        expected = _wrong(p.annotation, values[p.name], module)
        if expected:
            return f'{label}: "{p.name}" must be {expected}, not {_shown(values[p.name])}'
    return None


def _sentence(signatures, label, method, args, kwargs, module):
    if len(signatures) > 1 and len(args) == 1 + method and not kwargs:  # overloads differ by the type of one argument
        words = [_wrong(s.parameters[-1].annotation, args[-1], module) for s in signatures]
        if all(words):
            return f"{label}: expected {' or '.join(dict.fromkeys(words))}, not {_shown(args[-1])}"
    for signature in signatures:
        text = _complaint(signature, label, method, args, kwargs, module)
        if text:
            return text
    given = [_shown(a) for a in args[method:]] + [f"{k}={_shown(v)}" for k, v in kwargs.items()]
    return f"{label} cannot take {', '.join(given) or 'no arguments'}; see help({label.removesuffix('()')})"


def _wrap(function, label, method, module):
    overloads = function.__nb_signature__
    signatures = []  # parsed on first use

    @functools.wraps(function)
    def wrapper(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            if _MARK not in str(error):
                raise
            if not signatures:
                signatures.extend(map(_Signature, overloads))
            raise TypeError(_sentence(signatures, label, method, args, kwargs, module)) from None

    if len(overloads) == 1:  # for help() and completion
        wrapper.__signature__, wrapper.__doc__ = _Signature(overloads[0]).python, overloads[0][1]
    return wrapper


def _is_function(thing):
    return type(thing).__name__ in ("nb_func", "nb_method")


def install(module):
    """Wraps every function, method and setter of a nanobind module."""
    for name, thing in list(vars(module).items()):
        if _is_function(thing):
            setattr(module, name, _wrap(thing, f"{name}()", False, module))
        if not isinstance(thing, type) or type(thing).__module__ != "nanobind":
            continue
        for key, member in list(vars(thing).items()):
            if isinstance(member, property) and member.fset is not None and _is_function(member.fset):
                setter = _setter(member.fset, f"{name}.{key}", module)
                setattr(thing, key, property(member.fget, setter, member.fdel, member.__doc__))
            elif _is_function(member) and key not in _SKIP:
                operator = key.startswith("__")
                label = {"__getitem__": f"{name}[...]", "__setitem__": f"{name}[...]", "__contains__": f"in {name}"}.get(key, key)
                setattr(thing, key, _wrap(member, label if operator else f"{key}()", True, module))


def _setter(function, label, module):
    overload = function.__nb_signature__[0]

    def setter(self, value):
        try:
            function(self, value)
        except TypeError as error:
            if _MARK not in str(error):
                raise
            expected = _wrong(_Signature(overload).parameters[-1].annotation, value, module) or "another value"
            raise TypeError(f"{label} must be {expected}, not {_shown(value)}") from None

    return setter
