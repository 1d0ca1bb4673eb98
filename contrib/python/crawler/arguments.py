# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments of functions that are called with the kinds of their annotations, or refused in one sentence."""
import collections.abc
import functools
import inspect
import numbers
import os
import types
import typing

import numpy as np

from .needs import InputError

# Classes that an annotation admits, and its words.
KINDS = {bool: ((bool, np.bool_), "True or False"), int: ((numbers.Integral,), "a whole number"), float: ((numbers.Real,), "a number"),
         str: ((str,), "a text"), os.PathLike: ((os.PathLike,), "a path"), type(None): ((type(None),), "None"),
         collections.abc.Mapping: ((collections.abc.Mapping,), "a dict"), dict: ((dict,), "a dict"), list: ((list,), "a list"),
         collections.abc.Sequence: ((list, tuple, range), "a list"),  # or an array
         collections.abc.Iterable: ((collections.abc.Iterable,), "a list")}


def _kinds_of(annotation):
    """Classes and words of an annotation; None if it admits anything or a class that is not loaded."""
    origin = typing.get_origin(annotation)
    if origin in (typing.Union, types.UnionType):
        parts = [_kinds_of(one) for one in typing.get_args(annotation)]
        return None if None in parts else [kind for part in parts for kind in part]
    if (origin or annotation) in KINDS:
        return [KINDS[origin or annotation]]
    return [((annotation,), f"a {annotation.__name__}")] if isinstance(annotation, type) else None


def numbers_in(values, name):
    """Array of numbers of a list. Raises InputError if it has something else."""
    try:
        array = np.asarray(values)
    except ValueError:
        array = np.array(None)
    if array.ndim != 1 or not array.size or array.dtype.kind not in "iuf":
        raise InputError(f'"{name}" is {values!r}, but a list of numbers is expected')
    return array.astype(float)


def checked(function):
    """Decorates a function: it raises InputError for an argument that is not of the annotated kind."""
    signature = inspect.signature(function)
    kinds = {name: _kinds_of(one.annotation) for name, one in signature.parameters.items() if one.annotation is not inspect.Parameter.empty}

    @functools.wraps(function)
    def call(*values, **named):
        for name, value in signature.bind(*values, **named).arguments.items():
            admitted = kinds.get(name)
            is_text_for_list = isinstance(value, str) and admitted and not any(str in classes for classes, _ in admitted)
            is_array = hasattr(value, "__array__") and np.ndim(value) > 0 and any(list in classes for classes, _ in admitted or ())
            if admitted and (is_text_for_list or not (is_array or any(isinstance(value, classes) for classes, _ in admitted))):
                words = list(dict.fromkeys(words for _, words in admitted))
                raise InputError(f'"{name}" is {value!r}, but {" or ".join(filter(None, (", ".join(words[:-1]), words[-1])))} is expected')
        return function(*values, **named)
    return call
