"""Changes of a source text that a test of its lines should see, one a mutant.

Comparisons are turned over, sums become differences, ``and`` becomes ``or``, a number grows, a
truth value flips, a result becomes ``None``, a call whose result nobody takes is dropped. Texts,
annotations, decorators and kernels stay as they are: what a message says is read by people, and a
kernel would be compiled anew for every mutant.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import Any, cast

from typing_extensions import override

_COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
_OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
}
_KERNEL = "kernel"


@dataclass(frozen=True)
class Mutant:
    """One change.

    Attributes
    ----------
    line : int
        Where, from 1.
    before, after : str
        The expression or statement as it was and as it is.
    source : str
        The whole file with it.
    """

    line: int
    before: str
    after: str
    source: str


def count_mutants(source: str) -> int:
    """How many changes a source text allows."""
    changer = _Changer(-1)
    changer.visit(ast.parse(source))
    return changer.count


def mutant_of(source: str, number: int) -> Mutant:
    """The change of a number, from 0 to below :func:`count_mutants`."""
    changer = _Changer(number)
    tree = ast.fix_missing_locations(changer.visit(ast.parse(source)))
    return Mutant(changer.line, changer.before, changer.after, ast.unparse(tree))


class _Changer(ast.NodeTransformer):
    """Counts what can be changed, in the order of the text, and changes the one of a number.

    Parameters
    ----------
    wanted : int
        −1 changes nothing.
    """

    def __init__(self, wanted: int) -> None:
        self.count, self._wanted = 0, wanted
        self.line, self.before, self.after = 0, "", ""

    def _is_wanted(self) -> bool:
        self.count += 1
        return self.count - 1 == self._wanted

    def _changed(self, old: ast.AST, new: ast.AST) -> ast.AST:
        self.line = cast("ast.expr", old).lineno
        self.before, self.after = ast.unparse(old), ast.unparse(new)
        return ast.copy_location(new, old)

    @override
    def visit(self, node: ast.AST) -> Any:  # a node, as NodeTransformer's
        name = "_".join(("change", type(node).__name__.lower()))
        change = getattr(self, name, None)
        new = None if change is None else change(node)
        if new is not None and self._is_wanted():
            return self._changed(node, new)
        return super().visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        """Change what a function does, and its defaults; a kernel stays."""
        if any(isinstance(one, ast.Name) and one.id == _KERNEL for one in node.decorator_list):
            return node
        node.args.defaults = [self.visit(one) for one in node.args.defaults]
        node.body = [self.visit(one) for one in node.body]
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:
        """Change what stands in a class."""
        node.body = [self.visit(one) for one in node.body]
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        """Change a value, and not its annotation."""
        if node.value is not None:
            node.value = self.visit(node.value)
        return node

    def visit_If(self, node: ast.If) -> ast.AST:
        """Leave what only type checkers read."""
        if isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
            return node
        return self.generic_visit(node)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> ast.AST:
        """Leave texts."""
        return node

    def change_compare(self, node: ast.Compare) -> ast.AST:
        """Turn the first comparison over, or move its limit."""
        first, *others = node.ops
        return ast.Compare(node.left, [_COMPARISONS[type(first)](), *others], node.comparators)

    def change_binop(self, node: ast.BinOp) -> ast.AST | None:
        """Take the opposite operation; a text or a path with a text is no arithmetic."""
        turned = _OPERATORS.get(type(node.op))
        if turned is None or any(map(_is_text, (node.left, node.right))):
            return None
        return ast.BinOp(node.left, turned(), node.right)

    def change_boolop(self, node: ast.BoolOp) -> ast.AST:
        """Take ``or`` for ``and``, ``and`` for ``or``."""
        return ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)

    def change_unaryop(self, node: ast.UnaryOp) -> ast.AST | None:
        """Drop a ``not`` or a sign."""
        return node.operand if isinstance(node.op, (ast.Not, ast.USub)) else None

    def change_constant(self, node: ast.Constant) -> ast.AST | None:
        """Flip a truth value; make a number another one."""
        value = node.value
        if isinstance(value, bool):
            return ast.Constant(not value)
        if isinstance(value, int):
            return ast.Constant(value + 1)
        if isinstance(value, float):
            return ast.Constant(value * 2 or 1.0)
        return None

    def change_return(self, node: ast.Return) -> ast.AST | None:
        """Give nothing back."""
        if node.value is None or isinstance(node.value, ast.Constant):
            return None
        return ast.Return(ast.Constant(None))

    def change_expr(self, node: ast.Expr) -> ast.AST | None:
        """Drop a call whose result nobody takes."""
        return ast.Pass() if isinstance(node.value, ast.Call) else None


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
