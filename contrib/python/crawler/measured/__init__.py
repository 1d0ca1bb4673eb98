# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measured data: files of instruments and trackers become tables that a scene reads (doc/measured_data.md).

    from crawler import measured
    samples = measured.read_samples("tracks.csv", unit_of_t="1/30", unit_of_s="0.02")
    table = measured.prepare(samples, measured.Settings(smooth_s=0.4))
"""
from .preparation import Table, estimated_noise, find_period, prepare, strain_of_tracks
from .samples import Samples, read_samples
from .settings import Settings

__all__ = ["Samples", "Settings", "Table", "estimated_noise", "find_period", "prepare", "read_samples", "strain_of_tracks"]
