"""Everything that fails raises cosfly.Error; former names say what they are called now."""

import pickle

import pytest

import cosfly


BAD = {
    "run": (lambda: cosfly.run("nowhere", progress=False), cosfly.Error),
    "run, a list of changes": (lambda: cosfly.run("small", set=["seed=2"]), cosfly.WrongType),
    "run, a recipe of no tables": (lambda: cosfly.run({"stages": {"town": 3}}), cosfly.WrongType),
    "run, jobs": (lambda: cosfly.run("small", jobs=0, progress=False), cosfly.InvalidValue),
    "plan": (lambda: cosfly.plan("nowhere"), cosfly.Error),
    "why": (lambda: cosfly.why("small", "nothing"), cosfly.Error),
    "run, a number": (lambda: cosfly.run(3), cosfly.WrongType),
    "verify, no path": (lambda: cosfly.verify(None), cosfly.WrongType),
    "Expert, a dictionary": (lambda: cosfly.Expert({"name": "a"}), cosfly.WrongType),
    "verify": (lambda: cosfly.verify("nowhere", progress=False), cosfly.Error),
    "doctor": (lambda: cosfly.doctor("nowhere", progress=False), cosfly.Error),
    "doctor, a quota": (lambda: cosfly.doctor("data", quotas=["much"], progress=False), cosfly.InvalidValue),
    "evaluate": (lambda: cosfly.evaluate("nowhere"), cosfly.Error),
    "evaluate, a frame": (lambda: cosfly.evaluate("data", frame="moon"), cosfly.InvalidValue),
    "export": (lambda: cosfly.export("data", "betamax", "x", progress=False), cosfly.InvalidValue),
    "export, an option": (lambda: cosfly.export("data", "v7", "x", progress=False, colour=3), cosfly.InvalidValue),
    "preview": (lambda: cosfly.preview("data", "nobody", progress=False), cosfly.Error),
    "init": (lambda: cosfly.init("data"), cosfly.Error),
    "init, a start": (lambda: cosfly.init("new", "moon"), cosfly.InvalidValue),
    "decode_rgb": (lambda: cosfly.decode_rgb(b"no picture"), cosfly.Error),
    "decode_rgb, a size": (lambda: cosfly.decode_rgb(b"", size=(0, 1)), cosfly.InvalidValue),
    "Dataset": (lambda: cosfly.Dataset("nowhere"), cosfly.Error),
    "Dataset, no path": (lambda: cosfly.Dataset(None), cosfly.WrongType),
    "Dataset, a split": (lambda: cosfly.Dataset("data", split="exam"), cosfly.InvalidValue),
    "Dataset, a role": (lambda: cosfly.Dataset("data", role="chef"), cosfly.InvalidValue),
    "Dataset, a column": (lambda: cosfly.Dataset("data", columns=["nothing"]), cosfly.NotFound),
    "Dataset, a language": (lambda: cosfly.Dataset("data", captions="tlh"), cosfly.InvalidValue),
    "Dataset, a channel": (lambda: cosfly.Dataset("data", channels=("rgb", "rgbb")), cosfly.Error),
    "Dataset, a side": (lambda: cosfly.Dataset("data", size=5), cosfly.WrongType),
    "Dataset, one side": (lambda: cosfly.Dataset("data", size=(5,)), cosfly.WrongType),
    "Dataset, a side below 0": (lambda: cosfly.Dataset("data", size=(-1, 5)), cosfly.InvalidValue),
    "Dataset, a vast number of threads": (lambda: cosfly.Dataset("data", jobs=2**70)[-(10**9)], cosfly.OutOfRange),
    "Pack, a size": (lambda: cosfly.Pack("x", "data", size=(5, 5)), cosfly.WrongType),
    "Dataset, a size in words": (lambda: cosfly.Dataset("data", size="big"), cosfly.WrongType),
    "an order, a shard": (lambda: cosfly.Dataset("data").order(shard=3), cosfly.WrongType),
    "an order, a seed": (lambda: cosfly.Dataset("data").order(seed=-1), cosfly.InvalidValue),
    "preview, frames": (lambda: cosfly.preview("data", frames=[0, 10**6], progress=False), cosfly.Error),
    "Dataset, a number as channels": (lambda: cosfly.Dataset("data", channels=3), cosfly.WrongType),
    "Dataset, numbers as columns": (lambda: cosfly.Dataset("data", columns=[3]), cosfly.WrongType),
    "doctor, a quota alone": (lambda: cosfly.doctor("data", quotas="much", progress=False), cosfly.InvalidValue),
    "export, a number as splits": (lambda: cosfly.export("data", "v7", "x", splits=3, progress=False), cosfly.WrongType),
    "a state": (lambda: cosfly.Dataset("data").loader(2).load_state_dict({"epok": 1}), cosfly.InvalidValue),
    "Dataset, jobs": (lambda: cosfly.Dataset("data", jobs="two"), cosfly.WrongType),
    "a sample": (lambda: cosfly.Dataset("data")[10**9], cosfly.OutOfRange),
    "a sample by a fraction": (lambda: cosfly.Dataset("data")[1.5], cosfly.WrongType),
    "a trajectory": (lambda: cosfly.Dataset("data").trajectory("nobody"), cosfly.NotFound),
    "a town": (lambda: cosfly.Dataset("data").town("nowhere"), cosfly.NotFound),
    "a frame": (lambda: cosfly.Dataset("data").frame("expert-p00000", 10**6), cosfly.OutOfRange),
    "a frame by a fraction": (lambda: cosfly.Dataset("data").frame("expert-p00000", 1.5), cosfly.WrongType),
    "a table": (lambda: cosfly.Dataset("data").table("nothing"), cosfly.Error),
    "an order": (lambda: cosfly.Dataset("data").order(shard=(3, 2)), cosfly.InvalidValue),
    "a loader": (lambda: cosfly.Dataset("data").loader(0), cosfly.InvalidValue),
    "pack": (lambda: cosfly.pack("data", "data", progress=False), cosfly.InvalidValue),
    "Pack": (lambda: cosfly.Pack("data", "data"), cosfly.Error),
    "Expert": (lambda: cosfly.Expert("nowhere").plan_from([{}]), cosfly.Error),
    "Expert, a store": (lambda: cosfly.Expert("small", store="empty").plan_from([{}]), cosfly.Error),
}


@pytest.mark.parametrize("name", BAD)
def test_everything_that_fails_raises_an_error_with_a_code(name):
    work, kind = BAD[name]
    with pytest.raises(kind) as caught:
        work()
    error = caught.value
    assert error.code != "unknown" and str(error), repr(error)
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.code) == (type(error), str(error), error.code)


@pytest.mark.parametrize(
    "work, words",
    [
        (lambda: cosfly.Dataset("data", windows=True), r"windows\(\)"),
        (lambda: cosfly.Dataset("data", threads=2), "`jobs`"),
        (lambda: cosfly.run("small", overrides=["a=b"]), "`set`"),
        (lambda: cosfly.run("small", stor="x"), "did you mean `store`"),
        (lambda: cosfly.preview("data", trajectory="x"), "`trajectory_id`"),
        (lambda: cosfly.evaluate("data", splits_="x"), "did you mean `splits`"),
        (lambda: cosfly.export("data", "v7", "x", threads=2), "`jobs`"),
        (lambda: cosfly.pack("data", "x", threads=2), "`jobs`"),
        (lambda: cosfly.pack("data", "x", overrides={"size": 2}), "no option `overrides`"),
        (lambda: cosfly.Expert("small", threads=2), r"`jobs` of the method `plan_from\(\)`"),
        (lambda: cosfly.Expert("small", overrides={}), "`set`"),
        (lambda: cosfly.Expert("small").plan_from([], threads=2), "`jobs`"),
    ],
)
def test_keywords_that_are_none_are_refused_with_the_name_that_was_meant(work, words):
    with pytest.raises(cosfly.WrongType, match=words):
        work()


def test_former_names_say_what_they_are_called_now():
    with pytest.raises(AttributeError, match="cosfly.RunResult"):
        cosfly.Made
    [answer] = cosfly.Expert("small").plan_from([{"trajectory": "expert-p00000", "frame": 4, "position_in_world": [0, 0, 9]}])
    assert "`\"trajectory\"` is not a field" in (answer.error or "")


def test_a_name_alone_is_one_name():
    alone, listed = (cosfly.Dataset("data", channels=it, columns=("time_s",)) for it in ("rgb", ["rgb"]))
    assert alone.channels == listed.channels == ("rgb",) and "depth" not in alone[0]
    assert "time_s" in cosfly.Dataset("data", channels=(), columns="time_s")[0]
    assert list(alone.frame(alone.trajectory_ids[0], 0, "depth")) == ["depth"]
    with pytest.raises(cosfly.Error, match="`rgbb`"):
        cosfly.Dataset("data", channels="rgbb")
