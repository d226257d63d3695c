"""Keys carry the robot's name: what is said to one robot is heard by that one alone."""

from __future__ import annotations

import json
import time

import pytest
import zenoh

from overreach.errors import LinkError, SetupError
from overreach.link.messages import ANY, PROTOCOL, Accepted, Answer, Hello, check_name, decode_answer, encode, key
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest, StopRequest
from tests.processes import robot, until
from tests.said import said


def network(*endpoints: str) -> zenoh.Session:
    """Return a session that is connected to all of them."""
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("connect/endpoints", json.dumps(endpoints))
    return zenoh.open(config)


def test_two_robots_in_one_network_do_not_hear_each_other() -> None:
    """In a network that two robots are in, each arms for, moves and stops by what is said to its own name alone."""
    with robot("--name", "left") as (one, _, left), robot("--name", "right") as (two, _, right):
        assert (left.welcome.name, right.welcome.name) == ("left", "right")
        both = network(one, two)
        try:

            def ask(name: str, request: object) -> list[Answer]:
                replies = list(both.get(key(name, "request"), payload=encode(request), timeout=5.0))
                return [decode_answer(reply.ok.payload.to_bytes()) for reply in replies if reply.ok]

            def drive(name: str, first: int) -> None:
                for k in range(100):
                    seen = {"left": left, "right": right}[name].now.t
                    both.put(key(name, "command"), encode(said(7, first + k, 1, True, 0.3, 0.0, seen=seen)))
                    time.sleep(0.005)

            until(lambda: ask("left", ArmRequest(7)) == [Accepted()], what="the network")
            assert ask("right", ArmRequest(7)) == [Accepted()]  # one answer each
            drive("left", 1)
            assert left.speed() > 0.2
            assert right.speed() == 0.0
            until(lambda: left.speed() == 0.0, what="rest")
            drive("right", 1)
            assert right.speed() > 0.2
            assert left.speed() == 0.0
            assert ask("left", StopRequest()) == [Accepted()]
            until(lambda: left.now.stopped, what="the stop")
            assert not right.now.stopped
            assert (left.now.refused, right.now.refused) == (0, 0)
            chooser = OperatorEnd(one)
            try:
                assert chooser.welcome(5.0).name == "left"
            finally:
                chooser.close()
            hellos = list(both.get(key(ANY, "hello"), payload=encode(Hello(PROTOCOL, "")), timeout=5.0))
            assert len(hellos) == 2
        finally:
            both.close()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type


def test_a_robot_is_found_by_its_name_or_alone() -> None:
    """Without a name the one robot there is is found; with the name of another, nobody answers, and that is told."""
    with robot("--name", "left") as (endpoint, _, observer):
        assert observer.link.robot == "left"
        named = OperatorEnd(endpoint, "left")
        other = OperatorEnd(endpoint, "right")
        try:
            assert named.welcome(5.0).name == "left"
            with pytest.raises(LinkError, match="no robot side called 'right'"):
                other.welcome(0.5)
        finally:
            named.close()
            other.close()


@pytest.mark.parametrize("bad", ["", "a b", "a/b", "*", "$", "é", "x" * 41])
def test_names_that_cannot_be_keys(bad: str) -> None:
    """A robot's name is a part of a key: what cannot be one is refused at set-up."""
    with pytest.raises(SetupError, match="1 to 40 of"):
        check_name(bad)
