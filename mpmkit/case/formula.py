"""Formulas of a case: arithmetic over names, such as ``2 * radius + max(cell, 0.01)``.

Python's parser reads a formula, but only the operations listed here are computed; nothing else of Python can
be reached. Powers are not allowed, so that no short formula takes long or makes a huge number.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping
from typing import Any

from .synonyms import nearest

LONGEST = 300
"""Most characters of a formula."""
ROUNDING = 1e-9
"""Relative excess of a number over a whole number that counts as rounding."""
OPERATIONS: dict[type, Callable] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}


class NoNumber(ValueError):
    """Arithmetic that has no result, such as a division by zero; the formula itself may be sound."""


def _root(x: float) -> float:
    if x < 0:
        raise NoNumber(f"{x:g} has no square root")
    return math.sqrt(x)


def _ceil(x: float) -> float:
    """The whole number that is not below x; 30 for 0.3 / 0.01, which in binary is a little more."""
    return math.ceil(x - ROUNDING * max(1.0, abs(x)))


FUNCTIONS: dict[str, Callable[..., float]] = {
    "min": min,
    "max": max,
    "sqrt": _root,
    "cbrt": math.cbrt,
    "ceil": _ceil,  # for lengths in cells: a domain is a whole number of cells
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "radians": math.radians,
}
COUNT = {"min": 2, "max": 2}
"""Least number of arguments of the functions that take more than one."""
Node = ast.expr


def parse(text: str) -> Node:
    """The tree of a formula.

    Raises:
        ValueError: it is not a formula; the message continues a sentence after the formula.
    """
    if len(text) > LONGEST:
        raise ValueError(f"a formula has at most {LONGEST} characters, and this one {len(text)}")
    try:
        return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        raise ValueError(
            "this is not a formula; it must be made of numbers, names, + - * / ( ) and functions"
        ) from None


def evaluate(
    node: Node, names: Mapping[str, float], functions: Mapping[str, Callable[..., float]] = FUNCTIONS
) -> float:
    """The value of a formula for the given names and functions.

    An argument of a function may be a name in quotes, as of a wall: ``force('plate', 'z')``.

    Raises:
        ValueError: it has no value; the message continues a sentence after the formula.
    """
    match node:
        case ast.Constant(value=bool()):
            pass
        case ast.Constant(value=int() | float() as number):
            return float(number)
        case ast.Name(id=name):
            if name in names:
                return names[name]
            raise ValueError(f"there is no '{name}'{_meant(name, names)}")
        case ast.UnaryOp(op=operation, operand=operand) if type(operation) in OPERATIONS:
            return OPERATIONS[type(operation)](evaluate(operand, names, functions))
        case ast.BinOp(left=left, op=operation, right=right) if type(operation) in OPERATIONS:
            a, b = evaluate(left, names, functions), evaluate(right, names, functions)
            return _number(OPERATIONS[type(operation)], a, b)
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            if name not in functions:
                raise ValueError(f"there is no function '{name}'{_meant(name, functions)}")
            values = [_argument(argument, names, functions) for argument in arguments]
            if name in FUNCTIONS:
                if any(isinstance(value, str) for value in values):
                    raise ValueError("a number is needed, and not a name in quotes")
                least = COUNT.get(name, 1)
                if len(values) < least or (len(values) > 1 and name not in COUNT):
                    raise ValueError(f"{name} takes {'two or more numbers' if least > 1 else 'one number'}")
            return _number(functions[name], *values)
    raise ValueError(
        f"'{ast.unparse(node)}' is not allowed in a formula; it must be made of numbers, names, + - * / ( ) "
        f"and {', '.join(functions)}"
    )


def names_in(node: Node) -> set[str]:
    """The names that a formula uses, without those of functions."""
    called = {id(function) for function in _called(node)}
    return {name.id for name in ast.walk(node) if isinstance(name, ast.Name) and id(name) not in called}


def functions_in(node: Node) -> set[str]:
    """The names of the functions that a formula calls."""
    return {function.id for function in _called(node) if isinstance(function, ast.Name)}


def _called(node: Node) -> list[Node]:
    return [call.func for call in ast.walk(node) if isinstance(call, ast.Call)]


def with_numbers(node: Node, known: Mapping[str, float]) -> str:
    """The text of a formula, with numbers for the names that are known."""

    class Known(ast.NodeTransformer):
        def visit_Call(self, call: ast.Call) -> ast.Call:
            call.args = [self.visit(argument) for argument in call.args]  # its own name is that of a function
            return call

        def visit_Name(self, name: ast.Name) -> ast.expr:
            return ast.Constant(known[name.id]) if name.id in known else name

    return ast.unparse(Known().visit(node))


def _argument(node: Node, names: Mapping[str, float], functions: Mapping[str, Callable]) -> Any:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    return evaluate(node, names, functions)


def _number(function: Callable[..., float], *values: Any) -> float:
    try:
        found = float(function(*values))
    except ZeroDivisionError:
        raise NoNumber("it divides by zero") from None
    except TypeError:  # a name in quotes where a number must stand
        raise ValueError("a number is needed, and not a name in quotes") from None
    except OverflowError:
        raise NoNumber("it is too large for a number") from None
    if math.isinf(found):
        raise NoNumber("it is too large for a number")
    return found


def _meant(name: str, allowed: Mapping[str, Any]) -> str:
    near = nearest(name, list(allowed))
    return f"; did you mean '{near}'?" if near is not None else f"; there are {', '.join(sorted(allowed))}"
