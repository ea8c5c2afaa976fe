"""Functions that are commands: each takes the options of its command, and gives back all of its JSON."""

import inspect
import re
import subprocess
import sys

import pytest

import cosfly
from cosfly import _calls

# Options that a function leaves out: those of clusters, those that choose what is printed, and, of doctor, a file for what is returned.
LEFT_OUT = {"run": {"on", "request", "leaf", "quiet", "json"}, "doctor": {"out", "json"}}
FUNCTIONS = ["run", "plan", "why", "verify", "doctor", "evaluate", "export", "preview"]


class Called(Exception):
    """A command line, instead of its call."""


@pytest.mark.parametrize("name", FUNCTIONS)
def test_options_are_those_of_the_command(name, monkeypatch):
    def called(arguments, text, progress):
        raise Called(*arguments)

    monkeypatch.setattr(_calls, "_call", called)
    function = getattr(cosfly, name)
    parameters = inspect.signature(function).parameters.items()
    given = {key: value_of(it) for key, it in parameters if it.default is not inspect.Parameter.empty and key != "progress"}
    needed = ["x" for _, it in parameters if it.default is inspect.Parameter.empty and it.kind != inspect.Parameter.VAR_KEYWORD]
    with pytest.raises(Called) as caught:
        function(*needed, **given)
    command, *arguments = caught.value.args
    written = {word.split("=")[0][2:] for word in arguments if word.startswith("--")}
    told = subprocess.run([sys.executable, "-m", "cosfly", command, "--help"], capture_output=True, text=True, check=True).stdout
    own = told.split("Options of ")[0] if name == "export" else told
    known = set(re.findall(r"^ +(?:-\w, )?--([a-z-]+)", own, re.M)) - {"help"}
    assert written - {"json"} == known - LEFT_OUT.get(name, set()) - {"json"}


def value_of(parameter):
    """Some value of a parameter's kind."""
    if parameter.default is False:
        return True
    return {"a": 1} if "Settings" in str(parameter.annotation) else "1"


def test_a_field_that_results_do_not_know_fails_the_call(monkeypatch):
    real = _calls._call

    def with_more(arguments, text, progress):
        code, text, messages = real(arguments, text, progress)
        return code, text.replace('"all_measured"', '"all_are_measured"'), messages

    assert cosfly.plan("small", price=2.0).predicted_price is not None
    monkeypatch.setattr(_calls, "_call", with_more)
    with pytest.raises(TypeError, match="all_are_measured"):
        cosfly.plan("small")
