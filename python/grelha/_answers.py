"""Answers with what programs for Open3D ask of a tensor."""
import numpy as np


def _dtype_of(wanted):
    """A type of numbers; None for what is none, a device or a flag."""
    if wanted is None or isinstance(wanted, bool):
        return None
    for name in (wanted, str(wanted).lower()):
        try:
            return np.dtype(name)
        except TypeError:
            continue
    return None


class Answer(np.ndarray):
    """An array that is read like a tensor of Open3D: .numpy(), .cpu(), .isfinite() and so on.

    An element is an Answer too, without axes.
    """

    def numpy(self):
        """The numbers as a plain array; they are not copied."""
        return self.view(np.ndarray)

    def cpu(self):
        """This: there is no other device."""
        return self

    def to(self, *given, **named):
        """The numbers as another type, of numpy or Open3D. Devices change nothing."""
        for wanted in (*given, *named.values()):
            dtype = _dtype_of(wanted)
            if dtype is not None:
                return self.astype(dtype)
        return self

    def clone(self):
        """A copy."""
        return self.copy()

    def contiguous(self):
        """The same, row after row."""
        return answer(np.asarray(self, order="C"))

    def num_elements(self):
        """The number of elements."""
        return self.size

    def isfinite(self):
        """True for each number that is finite."""
        return np.isfinite(self)

    def isinf(self):
        """True for each infinity."""
        return np.isinf(self)

    def isnan(self):
        """True for each NaN."""
        return np.isnan(self)

    def __getitem__(self, index):
        part = super().__getitem__(index)
        return part if isinstance(part, Answer) else answer(part)

    def __hash__(self):
        if self.ndim:
            raise TypeError("unhashable: an array")
        return hash(self.item())

    def __array_wrap__(self, array, context=None, return_scalar=False):
        return answer(array)


def answer(array):
    """The same numbers as an Answer."""
    return np.asarray(array).view(Answer)
