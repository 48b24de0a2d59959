"""The packets of `actuator: {udp}` and `pose: {udp}`, and the rules by which a receiver of commands executes them.

Nothing here knows of an arm or of MuJoCo, so that the program of a real robot can use it unchanged.
"""

import math
import struct
from dataclasses import dataclass

# Little endian: magic, number, time of sending (ns), velocity x and y (m/s), yaw rate (rad/s), 1 for a stop, validity (ms).
COMMAND = struct.Struct("<4sQQdddBI")
# Magic, number.
ACKNOWLEDGEMENT = struct.Struct("<4sQ")
# Magic, number, position x and y (m), heading (rad).
POSE = struct.Struct("<4sQddd")

# A packet whose number is farther ahead is none of the sequence.
LARGEST_STEP = 1 << 32
# After so much time (s) the shortest delay is measured anew, because clocks drift apart.
MEMORY_S = 30.0


@dataclass(frozen=True)
class Command:
    """Velocity of the centre of mass in the world frame (m/s), yaw rate (rad/s), and for how long (s) they hold."""

    number: int
    sent_s: float
    velocity_m_s: tuple[float, float]
    yaw_rate_rad_s: float
    is_stop: bool
    valid_s: float

    def to_bytes(self):
        """The packet `VBC1`."""
        numbers = (*self.velocity_m_s, self.yaw_rate_rad_s, self.is_stop, round(self.valid_s * 1e3))
        return COMMAND.pack(b"VBC1", self.number, round(self.sent_s * 1e9), *numbers)

    @classmethod
    def from_bytes(cls, packet):
        """Reads a packet. Gives `None` for bytes that are no command, or whose numbers are not finite."""
        if len(packet) != COMMAND.size:
            return None
        magic, number, sent_ns, x, y, yaw_rate, stop, valid_ms = COMMAND.unpack(packet)
        if magic != b"VBC1" or stop > 1 or not all(map(math.isfinite, (x, y, yaw_rate))):
            return None
        return cls(number, sent_ns * 1e-9, (x, y), yaw_rate, bool(stop), valid_ms * 1e-3)


def acknowledgement(number):
    """The packet `VBA1`."""
    return ACKNOWLEDGEMENT.pack(b"VBA1", number)


def acknowledged(packet):
    """The number in a packet `VBA1`, or `None`."""
    if len(packet) != ACKNOWLEDGEMENT.size or packet[:4] != b"VBA1":
        return None
    return ACKNOWLEDGEMENT.unpack(packet)[1]


def pose(number, position_m, heading_rad):
    """The packet `VBP1`."""
    return POSE.pack(b"VBP1", number, *position_m, heading_rad)


def posed(packet):
    """Number, position (m) and heading (rad) in a packet `VBP1`, or `None`."""
    if len(packet) != POSE.size or packet[:4] != b"VBP1":
        return None
    _, number, x, y, heading = POSE.unpack(packet)
    return number, (x, y), heading


class Receiver:
    """Decides which commands are executed, and for how long. All times are those of the receiver's own clock (s).

    A command holds until the next one, but not longer than its packet says. `braking_s` is the time that the robot needs to come
    to rest. The receiver gives the command up so much earlier, so that the robot stands when the time in the packet is over.
    """

    def __init__(self, braking_s, oldest_s=0.05):
        self.braking_s, self.oldest_s = braking_s, oldest_s
        self.command, self.until_s = None, -math.inf
        self.last = None  # number of the newest packet in order
        self.run = None  # number of a sender that may have started again, and when its numbers began to grow
        self.delays = [math.inf, math.inf, -math.inf]  # shortest delay of the time before and of this one, which began then

    def take(self, packet, now_s):
        """Takes the bytes of a packet. Gives the acknowledgement, or `None` if the packet is not executed."""
        command = Command.from_bytes(packet)
        if command is None or not self._in_order(command.number, now_s):
            return None
        age_s = self._age_s(command.sent_s, now_s)
        # A stop is executed at any age.
        if age_s > self.oldest_s and not command.is_stop:
            return None
        self.command, self.until_s = command, now_s - age_s + command.valid_s - self.braking_s
        return acknowledgement(command.number)

    def wanted(self, now_s):
        """Velocity x and y (m/s) and yaw rate (rad/s) that the robot should have now. All zero after the time in the packet."""
        if self.command is None or self.command.is_stop or now_s >= self.until_s:
            return 0.0, 0.0, 0.0
        return *self.command.velocity_m_s, self.command.yaw_rate_rad_s

    def _in_order(self, number, now_s):
        """True for a number that follows the last one, or that of a sender that has started again and sent for `oldest_s`."""
        if self.last is None or 0 < number - self.last <= LARGEST_STEP:
            self.last, self.run = number, None
            return True
        grows = self.run is not None and 0 < number - self.run[0] <= LARGEST_STEP
        self.run = (number, self.run[1] if grows else now_s)
        if now_s - self.run[1] <= self.oldest_s:
            return False
        self.last, self.run = number, None
        self.delays = [math.inf, math.inf, -math.inf]
        return True

    def _age_s(self, sent_s, now_s):
        """The delay beyond the shortest one, because sender and receiver have different clocks."""
        before, since, began = self.delays
        if now_s - began >= MEMORY_S:
            before, since, began = since, math.inf, now_s
        delay = now_s - sent_s
        since = min(since, delay)
        self.delays = [before, since, began]
        return delay - min(before, since)
