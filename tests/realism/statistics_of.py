"""Statistics of pictures and of theory: plain functions of arrays."""
import numpy as np


def db(power):
    return 10 * np.log10(power)


def power(level_db):
    return 10 ** (np.asarray(level_db) / 10)


def taylor(count, side_lobe_db, n_bar=4):
    """Taylor's weights of `count` samples, mean 1 [T. T. Taylor, 1955]."""
    a = np.arccosh(10 ** (-side_lobe_db / 20)) / np.pi
    sigma2 = n_bar**2 / (a**2 + (n_bar - 0.5) ** 2)
    weights = np.ones(count)
    place = (np.arange(count) - (count - 1) / 2) / count
    for m in range(1, n_bar):
        above = np.prod([1 - m**2 / (sigma2 * (a**2 + (n - 0.5) ** 2)) for n in range(1, n_bar)])
        below = np.prod([1 - m**2 / n**2 for n in range(1, n_bar) if n != m])
        weights += 2 * (-1) ** (m + 1) * above / (2 * below) * np.cos(2 * np.pi * m * place)
    return weights / weights.mean()


def taylor_correlation(lag_cells, side_lobe_db=-35):
    """Correlation of the intensity of speckle behind Taylor weights, `lag_cells` resolution cells (1 / B) apart.

    Speckle is Gaussian noise through the processor, so that fields correlate as the transform of the squared weights,
    and intensities as its square, whatever the number of looks.
    """
    weights2 = taylor(4096, side_lobe_db) ** 2
    place = (np.arange(4096) - 2047.5) / 4096
    field = (weights2 * np.exp(2j * np.pi * place * lag_cells)).sum() / weights2.sum()
    return abs(field) ** 2


def looks(values):
    """Equivalent number of looks of powers: squared mean over variance."""
    return values.mean() ** 2 / values.var()


def correlation(values, lag, axis):
    """Normalised covariance of neighbours `lag` pixels apart along an axis; the mean is that of the whole."""
    near = np.take(values, range(values.shape[axis] - lag), axis)
    far = np.take(values, range(lag, values.shape[axis]), axis)
    middle = values.mean()
    return ((near - middle) * (far - middle)).mean() / values.var()


def correlation_at(values, lag_px, axis):
    """The same for a lag between pixels: a parabola through the three nearest whole lags."""
    nearest = max(1, round(lag_px))
    lags = [nearest - 1, nearest, nearest + 1]
    return float(np.polyval(np.polyfit(lags, [correlation(values, n, axis) if n else 1.0 for n in lags], 2), lag_px))


def masked_correlation(values, mask, lag):
    """Correlation of pairs `lag` pixels apart, along rows and columns, both of which the mask holds.

    Of the deviations from the mask's median: a class's level is not part of its texture.
    """
    rest = np.where(mask, values - np.median(values[mask]), 0)
    pairs = total = 0.0
    for axis in (0, 1):
        near = np.take(rest, range(rest.shape[axis] - lag), axis)
        far = np.take(rest, range(lag, rest.shape[axis]), axis)
        both = np.take(mask, range(mask.shape[axis] - lag), axis) & np.take(mask, range(lag, mask.shape[axis]), axis)
        total += (near[both] * far[both]).sum()
        pairs += both.sum()
    return total / pairs / (rest[mask] ** 2).mean()


def brightest_share(values, part=0.01):
    """Share of all power that the brightest `part` of the pixels hold."""
    ordered = np.sort(values.ravel())
    return ordered[-max(1, round(part * len(ordered))):].sum() / ordered.sum()


def pooled_looks(sweeps):
    """Looks of pictures of the same ground with other noise, [sweep][line][bin]: the median over pixels.

    Of each pixel over the sweeps, so that no slope of the picture counts. The squared mean is freed of its own error.
    """
    count = len(sweeps)
    variance = sweeps.var(axis=0, ddof=1)
    mean2 = sweeps.mean(axis=0) ** 2 - variance / count
    return float(np.mean(mean2) / np.mean(variance))
