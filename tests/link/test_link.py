from __future__ import annotations

import time

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.errors import LinkError, SetupError
from overreach.link import messages
from overreach.link.endpoint import check_endpoint, free_port, open_session
from overreach.link.messages import KEY_HELLO, KEY_REQUEST, KEY_STICK, Accepted, Configure, Hello, Refused, Settings
from overreach.link.operator_end import OperatorEnd
from overreach.types import Frame, Stick
from tests.processes import Driver, half, robot, until


@given(st.builds(Stick, st.integers(0, 2**53), st.integers(0, 2**53), st.integers(0, 2**31), st.booleans(),
                 st.floats(allow_nan=False), st.floats(allow_nan=False)))  # fmt: skip
def test_messages_come_back_as_they_went(stick: Stick) -> None:
    """What is encoded decodes to the same."""
    assert messages.decode_stick(messages.encode(stick)) == stick


@pytest.mark.parametrize(
    ("given_", "full"),
    [
        ("127.0.0.1:7460", "tcp/127.0.0.1:7460"),
        ("tcp/robot.local:7460", "tcp/robot.local:7460"),
        ("[::1]:7460", "tcp/[::1]:7460"),
    ],
)
def test_endpoints(given_: str, full: str) -> None:
    """HOST:PORT is taken as TCP; zenoh's own form is taken as it is."""
    assert check_endpoint(given_) == full


@pytest.mark.parametrize(
    "bad", ["", "robot", "robot:0", "robot:70000", "tcp/robot", "tls/robot:7460", "http://robot:80", "a b:80"]
)
def test_bad_endpoints(bad: str) -> None:
    """What is no endpoint is refused with the form that is."""
    with pytest.raises(SetupError, match="HOST:PORT"):
        check_endpoint(bad)


def test_a_robot_side_end_to_end() -> None:
    """Over the real wire: welcome, arm, drive beyond the arm's reach, settings refused whole, stop, reset."""
    with robot() as (_, _, observer):
        assert observer.welcome.robot == "planar"
        start = observer.now
        driver = Driver(observer.link)
        driver.arm()
        driver.drive(2.5)
        assert observer.now.x_e - start.x_e > 0.7
        assert observer.now.mu > 0.9
        assert observer.now.ack <= driver.seq

        answer = observer.link.request(Configure(Settings(law="paper", l_max=1.5)))
        assert isinstance(answer, Refused)
        assert "reach" in answer.reason
        answer = observer.link.request(Configure(Settings(law="papper")))
        assert isinstance(answer, Refused)
        assert "Did you mean 'paper'" in answer.reason
        raw = messages.encode({"type": "configure", "settings": {"frame": "hnad"}})
        assert "hnad" in str(observer.link._ask(KEY_REQUEST, msgspec.Raw(raw), 2.0))
        answer = observer.link.request(Configure(Settings(law="e" * 3000)))
        assert isinstance(answer, Refused)
        assert len(answer.reason) < 200
        assert observer.link.welcome(1.0).settings == Settings()
        until(lambda: observer.speed() == 0.0, what="rest")
        wanted = Settings(law="paper", frame=Frame.POLAR, blend="tanh", alpha=80.0, speed_scale=0.5)
        assert observer.link.request(Configure(wanted)) == Accepted()
        assert observer.link.welcome(1.0).settings == wanted

        assert isinstance(observer.link.request(messages.Restart()), Refused)  # it is armed
        assert observer.link.request(messages.Stop()) == Accepted()
        until(lambda: observer.now.stopped and observer.speed() == 0.0)
        driver.grip += 1
        driver.drive(0.3)
        assert observer.speed() == 0.0
        assert isinstance(observer.link.request(messages.Arm(7)), Refused)
        assert observer.link.request(messages.Reset()) == Accepted()
        assert observer.link.request(messages.Restart()) == Accepted()
        until(lambda: observer.now.x_e == pytest.approx(start.x_e))


def test_a_rival_is_loaded_at_rest_and_then_driven() -> None:
    """A law that is not in memory is refused in motion, which loading would hold up; at rest it is taken and drives."""
    with robot() as (_, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        driver.drive(0.5)
        answer = observer.link.request(Configure(Settings(law="qp")))
        assert isinstance(answer, Refused)
        assert "Let go first: 'qp'" in answer.reason
        until(lambda: observer.speed() == 0.0, what="rest")
        assert observer.link.request(Configure(Settings(law="qp"))) == Accepted()
        start = observer.now
        driver.grip += 1
        driver.drive(1.0)
        assert observer.now.x_e - start.x_e > 0.1
        assert observer.now.x_b > start.x_b  # the QP drives the base inside the workspace
        assert observer.link.request(Configure(Settings())) == Accepted()
        assert observer.link.request(Configure(Settings(law="qp"))) == Accepted()  # now it is in memory


def test_garbage_is_counted_and_dropped() -> None:
    """Bytes that are no message, of no known form or of the wrong types, move nothing and end nothing."""
    with robot() as (endpoint, running, observer):
        raw = open_session(connect=endpoint)
        try:
            driver = Driver(observer.link)
            driver.arm()
            deep = b"\x81\xa1x" + b"\x91" * 3000 + b"\xc0"
            junk = [
                deep,
                b"\x81\xa1x" + b"\x91" * 200_000 + b"\xc0",
                b"",
                b"\x00",
                b"\xff" * 64,
                b"x" * 100_000,
                messages.encode({"v_c": 1}),
                messages.encode([1, 2]),
            ]
            wrong = [messages.encode({"operator": 7, "seq": 1, "grip": 1, "held": "yes", "v_c": 0.4, "w_c": 0.0})]
            for payload in junk + wrong:
                raw.put(KEY_STICK, payload)
                time.sleep(0.03)
                for key in (KEY_REQUEST, KEY_HELLO):
                    replies = list(raw.get(key, payload=payload, timeout=2.0))
                    assert len(replies) == 1
                    assert replies[0].ok is not None
                    assert isinstance(messages.decode_answer(replies[0].ok.payload.to_bytes()), Refused)
            until(lambda: observer.now.refused >= 3 * len(junk), what="the count of what was refused")
            assert observer.speed() == 0.0
            assert running.process.poll() is None
            driver.drive(0.5)
            assert observer.speed() > 0.0
        finally:
            raw.close()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type


def test_another_protocol_is_refused_with_both_versions() -> None:
    """Halves of different protocols do not drive: the robot side says which versions met."""
    with robot() as (_, _, observer):
        answer = observer.link._ask(KEY_HELLO, Hello(messages.PROTOCOL + 1, "9.9.9"), 2.0)
        assert isinstance(answer, Refused)
        assert "9.9.9" in answer.reason


def test_nobody_there() -> None:
    """Without a robot side the operator side says which command starts one."""
    link = OperatorEnd(f"tcp/127.0.0.1:{free_port()}")
    try:
        with pytest.raises(LinkError, match="overreach robot --listen"):
            link.welcome(0.3)
    finally:
        link.close()


def test_a_taken_port_is_told() -> None:
    """A second robot side at the same endpoint ends with one line and exit code 2."""
    with robot() as (endpoint, _, _), half("robot", "--listen", endpoint) as second:
        assert second.process.wait(20) == 2
        assert second.process.stderr
        assert "cannot listen" in second.process.stderr.read()
