"""The type stubs describe what is there."""

import ast
import inspect
import pathlib

import vibrissa
from vibrissa import _native

STUB = ast.parse(pathlib.Path(vibrissa.__file__).with_name("_native.pyi").read_text())


def public(names):
    return {name for name in names if not name.startswith("_")}


def parameters(function):
    arguments = function.args
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, *filter(None, [arguments.kwarg])]
    return [argument.arg for argument in every if argument.arg not in ("self", "cls")]


def test_classes_have_the_members_and_parameters_of_the_stub():
    classes = [item for item in STUB.body if isinstance(item, ast.ClassDef) and item.name != "Error"]
    assert {item.name for item in classes} | {"Error"} == {
        name for name, value in vars(_native).items() if inspect.isclass(value)
    }
    for item in classes:
        found = getattr(_native, item.name)
        functions = [member for member in item.body if isinstance(member, ast.FunctionDef)]
        assert public(member.name for member in functions) == public(vars(found)), item.name
        for member in functions:
            if member.name == "__getattr__":
                # The native part has it without a name.
                continue
            called = found if member.name == "__new__" else getattr(found, member.name)
            if callable(called) and not any(getattr(name, "id", "") == "property" for name in member.decorator_list):
                signature = [name for name in inspect.signature(called).parameters if name != "self"]
                assert signature == parameters(member), f"{item.name}.{member.name}"


def test_functions_have_the_parameters_of_the_stub():
    for item in STUB.body:
        if isinstance(item, ast.FunctionDef):
            assert list(inspect.signature(getattr(_native, item.name)).parameters) == parameters(item), item.name


def test_all_public_names_are_exported():
    native = {name for name in public(vars(_native)) if name not in ("has_mujoco", "use_mujoco")}
    assert set(vibrissa.__all__) == native | {"run", "PolicyWarning"}
