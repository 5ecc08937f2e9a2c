"""Supports and bearings of the valid calls."""

from __future__ import annotations

import dataclasses
from functools import cached_property

import numpy as np

import exudyn_rotor as er


class Bearings:
    """One of each kind, made when it is first asked for, and once."""

    @cached_property
    def film(self) -> er.OilFilm:
        """A film on a coarse grid between two grooves."""
        return er.OilFilm(0.05, 0.05, 0.02, er.grooved_pads(1e-4, [0.5, 3.6], 0.3), nodes=24)

    @cached_property
    def supports(self) -> tuple[er.Support, ...]:
        """Two bearings; the first also holds the rotor along its axis."""
        return (
            er.Support("left", np.diag([1e6, 1e6, 1e6]), 100.0),
            er.Support("right", 1e6, 100.0),
        )

    @cached_property
    def isotropic(self) -> tuple[er.Support, ...]:
        """Bearings whose damper turns with the rotor, too: unstable above some speed."""
        return (
            er.Support("left", np.diag([1e6, 1e6, 1e6]), 10.0),
            er.Support("right", 1e6, 10.0),
            er.Support("left", damping=100.0, frame="rotor"),
            er.Support("right", damping=100.0, frame="rotor"),
        )

    @cached_property
    def journal(self) -> er.ShortJournalBearing:
        """A journal bearing under a load."""
        size = {"radius": 0.05, "length": 0.03, "clearance": 1e-4, "viscosity": 0.1}
        return er.ShortJournalBearing(interface="left", load=[0.0, -500.0], **size)

    @cached_property
    def film_bearing(self) -> er.JournalBearing:
        """A journal bearing with a film of finite length."""
        return er.JournalBearing(interface="left", film=self.film, load=[0.0, -500.0])

    @cached_property
    def tilting(self) -> er.TiltingPadBearing:
        """A bearing of two tilting pads."""
        pads = er.grooved_pads(1e-4, [0.0, np.pi], 0.5, preload=0.3)
        film = er.OilFilm(0.05, 0.05, 0.1, pads, nodes=24, axial_nodes=0)
        return er.TiltingPadBearing(
            interface="left", film=film, load=[0.0, -500.0], pad_inertia=1e-5
        )

    @cached_property
    def rolling(self) -> er.RollingBearing:
        """A ball bearing."""
        sizes = {"count": 8, "pitch_radius": 0.0326, "element_radius": 0.006, "stiffness": 7e9}
        return er.RollingBearing(interface="left", load=[0.0, -500.0], **sizes)

    @cached_property
    def damper(self) -> er.SqueezeFilmDamper:
        """A squeeze-film damper with a spring that carries the loads of the calls."""
        size = {"radius": 0.06, "length": 0.02, "clearance": 1e-3, "viscosity": 0.01}
        return er.SqueezeFilmDamper(interface="left", centring_stiffness=5e6, **size)

    @cached_property
    def magnetic(self) -> er.MagneticBearing:
        """A magnetic bearing that carries the loads of the calls."""
        magnets = {"constant": 1e-3, "bias_current": 2.0, "gap": 4e-3, "current_limit": 6.0}
        gains = {"proportional": 2e3, "integral": 1e3, "derivative": 0.5, "delay": 1e-5}
        return er.MagneticBearing(
            interface="left",
            sensor="left",
            actuator=er.SaturatingActuator(**magnets),
            controller=er.PIDController(**gains, filter_frequency=2e4, amplifier_frequency=1e4),
            load=[0.0, -500.0],
        )

    @cached_property
    def magnetic_right(self) -> er.MagneticBearing:
        """The same at the other end."""
        return dataclasses.replace(self.magnetic, interface="right", sensor="right")

    @cached_property
    def seal(self) -> er.AnnularSeal:
        """A seal of a pump."""
        size = {"radius": 0.1, "length": 0.05, "clearance": 3e-4, "pressure_drop": 1e6}
        return er.AnnularSeal(interface="left", density=1000.0, viscosity=1e-3, **size)

    @cached_property
    def stop(self) -> er.ClearanceStop:
        """A stop behind a clearance."""
        return er.ClearanceStop(interface="left", radius=0.05, clearance=1e-4, stiffness=1e7)
