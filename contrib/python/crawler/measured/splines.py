# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smoothing splines (Reinsch 1967) that flatten no wave at the ends of the data."""
import numpy as np
from numpy.polynomial import polynomial
from scipy.interpolate import CubicSpline
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import spsolve


def _fitted(x, y, width, weights, is_periodic):
    """Values f at the knots x that minimise sum w (y - f)^2 + lambda int f''^2 dx, lambda = (width/2 pi)^4/h with the
    mean step h; f is natural (f'' = 0 at the ends) or periodic (the last knot is the first of the next period)."""
    h = np.diff(x)
    n = len(h) if is_periodic else len(x)
    rows = np.arange(n if is_periodic else n - 2)
    left, right = (np.roll(h, 1), h) if is_periodic else (h[:-1], h[1:])
    middle = rows if is_periodic else rows + 1
    entries = np.concatenate([1 / left, -1 / left - 1 / right, 1 / right])
    columns = np.concatenate([middle - 1, middle, middle + 1]) % n
    q = csc_matrix((entries, (np.tile(rows, 3), columns)), shape=(len(rows), n))  # second differences
    r = csc_matrix((np.concatenate([left / 6, (left + right) / 3, right / 6]), (np.tile(rows, 3), columns)), shape=(len(rows), n))
    r = r if is_periodic else r[:, 1:-1]
    inverse = diags(1 / weights[:n])
    strength = (width / (2 * np.pi))**4 / np.mean(h)
    curvatures = spsolve(csc_matrix(r + strength * (q @ inverse @ q.T)), q @ y[:n])
    fitted = y[:n] - strength * (inverse @ (q.T @ curvatures))
    return np.append(fitted, fitted[0]) if is_periodic else fitted


def periodic_spline(x, y, width, weights):
    """Smoothing spline of a period, CubicSpline; x: knots [n], of which the last is the first one of the next period;
    y, weights: [n]. Width 0 interpolates y."""
    y = np.append(y[:-1], y[0])
    values = _fitted(x, y, width, weights, True) if width > 0 else y
    return CubicSpline(x, values, bc_type="periodic")


class _Polynomial:
    """Polynomials with the coefficients [degree + 1] or [degree + 1, m] of the powers of (x - middle)/size."""

    def __init__(self, coefficients, middle, size):
        self.coefficients, self.middle, self.size = coefficients, middle, size

    @classmethod
    def nearest(cls, x, y, degree):
        """Polynomial nearest to samples y [n] or [n, m]."""
        middle, size = (x[0] + x[-1]) / 2, (x[-1] - x[0]) / 2
        return cls(polynomial.polyfit((x - middle) / size, y, degree), middle, size)

    def __call__(self, x, order=0):
        coefficients = polynomial.polyder(self.coefficients, order) / self.size**order
        powers = ((np.asarray(x) - self.middle) / self.size)[..., np.newaxis]**np.arange(len(coefficients))
        return powers @ coefficients


class SmoothingSpline:
    """Smoothing splines of samples y [n] or [n, m] at knots x [n >= 4]: f(x) or f(x, order of the derivative), [...,
    m].

    From many equally spaced samples a wave of the length P is kept to the part 1/(1 + (width/P)^4): waves of the length
    width are halved. Width 0 interpolates the samples. The functional requires f'' = 0 at the ends; so that waves are
    not flattened there, the nearest polynomial (degree 1 + length/width, 3 to 9) is subtracted before and added again,
    and from the rest a cubic whose f'' at the ends is that of the samples within a width of them.
    """

    def __init__(self, x, y, width):
        self.smooth = []  # polynomials
        if not width > 0:
            self.rest = CubicSpline(x, y)
            return
        length, n = x[-1] - x[0], len(x)
        near = [(x - x[0] <= width), (x[-1] - x <= width)]
        is_sparse = min(part.sum() for part in near) <= 4
        degree = 3 if is_sparse else int(min(max(1 + length / width, 3), 9, 2 * np.sqrt(n) - 1))
        self.smooth.append(_Polynomial.nearest(x, y, min(degree, n - 1)))
        rest = y - self.smooth[0](x)
        curvatures = [(CubicSpline(x, rest) if part.sum() <= 4 else _Polynomial.nearest(x[part], rest[part], 3))(end, 2)
                      for part, end in zip(near, (x[0], x[-1]))]
        zero = np.zeros_like(curvatures[0])
        cubic = np.array([zero, zero, curvatures[0] / 2, (curvatures[1] - curvatures[0]) / (6 * length)])
        self.smooth.append(_Polynomial(cubic, x[0], 1.0))
        rest = y - sum(part(x) for part in self.smooth)
        self.rest = CubicSpline(x, _fitted(x, rest, width, np.ones(n), False), bc_type="natural")

    def __call__(self, x, order=0):
        return self.rest(x, order) + sum(part(x, order) for part in self.smooth)
