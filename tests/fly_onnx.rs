//! Policies in ONNX: flown, kept in bundles, run again by `verify` and on leaderboards; files that are wrong.

use crate::street::Street;
use crate::support::{Printed, cosfly, repository_root, tree_digests};
use cosfly_fly::bundle::Bundle;
use cosfly_fly::pilot::OnnxPolicy;
use cosfly_fly::results::PolicyCard;
use serde_json::{Value, json};
use std::path::Path;

/// A field of a message of protocol buffers: a text, or a message.
fn field(number: u8, bytes: &[u8]) -> Vec<u8> {
    let mut length = bytes.len();
    let mut out = vec![number << 3 | 2];
    while length > 127 {
        out.push(length as u8 | 128);
        length >>= 7;
    }
    out.push(length as u8);
    [out, bytes.to_vec()].concat()
}

fn whole(number: u8, value: u8) -> Vec<u8> {
    vec![number << 3, value]
}

fn port(name: &str, shape: &[u8]) -> Vec<u8> {
    let sizes = shape.iter().flat_map(|size| field(1, &whole(1, *size))).collect::<Vec<u8>>();
    let tensor = [whole(1, 1), field(2, &sizes)].concat();
    [field(1, name.as_bytes()), field(2, &field(1, &tensor))].concat()
}

fn constant(name: &str, shape: &[u8], values: &[f32]) -> Vec<u8> {
    let sizes = shape.iter().flat_map(|size| whole(1, *size)).collect::<Vec<u8>>();
    let raw: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    [sizes, whole(2, 1), field(8, name.as_bytes()), field(9, &raw)].concat()
}

fn node(operator: &str, inputs: &[&str], output: &str) -> Vec<u8> {
    let inputs = inputs.iter().flat_map(|name| field(1, name.as_bytes())).collect::<Vec<u8>>();
    [inputs, field(2, output.as_bytes()), field(4, operator.as_bytes())].concat()
}

/// A file: nodes, constants, inputs, outputs, and the description.
fn network(parts: [&[Vec<u8>]; 4], description: &Value) -> Vec<u8> {
    let [nodes, constants, inputs, outputs] = parts;
    let all = |number: u8, list: &[Vec<u8>]| list.iter().flat_map(|it| field(number, it)).collect::<Vec<u8>>();
    let graph = [all(1, nodes), all(5, constants), all(11, inputs), all(12, outputs)].concat();
    let entry = [field(1, b"cosfly"), field(2, description.to_string().as_bytes())].concat();
    [whole(1, 8), field(7, &graph), field(8, &whole(2, 17)), field(14, &entry)].concat()
}

fn description(observation: &str, unit: &str) -> Value {
    json!({
        "version": 1,
        "inputs": { "seen": { "observation": observation, "unit": unit } },
        "output": { "name": "actions", "actions": "velocity", "unit": "m/s, degrees/s" },
    })
}

/// Weights that fly towards the target: velocity of the target, and a turn towards it.
fn weights() -> Vec<f32> {
    let mut weights = vec![0.0; 16 * 5];
    (0..3).for_each(|axis| weights[(3 + axis) * 5 + axis] = 1.0);
    weights[5 + 4] = 3.0;
    weights
}

/// A network that sees the state and remembers its last action: actions = state x weights + memory / 2.
fn of_state(description: &Value) -> Vec<u8> {
    network(
        [
            &[
                node("MatMul", &["seen", "weights"], "now"),
                node("Mul", &["memory", "half"], "kept"),
                node("Add", &["now", "kept"], "actions"),
            ],
            &[constant("weights", &[16, 5], &weights()), constant("half", &[], &[0.5])],
            &[port("seen", &[1, 16]), port("memory", &[1, 5])],
            &[port("actions", &[1, 5])],
        ],
        description,
    )
}

fn with_memory(observation: &str, unit: &str) -> Value {
    let mut described = description(observation, unit);
    described["states"] = json!({ "memory": "actions" });
    described
}

/// A network that sees colours, in four pictures.
fn of_colours() -> Vec<u8> {
    let mut described = description("rgb", "0..1");
    described["inputs"]["seen"]["history"] = json!(4);
    network(
        [
            &[
                node("GlobalAveragePool", &["seen"], "means"),
                node("Flatten", &["means"], "row"),
                node("MatMul", &["row", "weights"], "actions"),
            ],
            &[constant("weights", &[12, 5], &weights()[..60])],
            &[port("seen", &[1, 12, 16, 16])],
            &[port("actions", &[1, 5])],
        ],
        &described,
    )
}

fn fly(folder: &Path, policy: &str, more: &[&str]) -> Printed {
    let fly = ["fly", "recipe.toml", "--policy", policy, "--clips", "0", "--logs", "none", "--quiet"];
    cosfly(&[&fly[..], more].concat()).within(folder).run()
}

fn board(folder: &Path, more: &[&str]) -> (Printed, Value) {
    let all = [&["leaderboard", "board", "--suite", "recipe.toml", "--run-policies", "--json"], more].concat();
    let printed = cosfly(&all).within(folder).run();
    let table =
        serde_json::from_str(&printed.stdout).unwrap_or_else(|_| panic!("{}{}", printed.stdout, printed.stderr));
    (printed, table)
}

fn files(of: &Value) -> Vec<&str> {
    of.as_array().expect("a list").iter().map(|it| it["file"].as_str().expect("a name")).collect()
}

#[test]
fn a_network_flies_the_same_for_any_jobs_and_is_run_again() {
    let street = Street::new();
    let at = |name: &str| street.path().join(name);
    std::fs::create_dir(at("board")).expect("a folder");
    std::fs::write(at("mine.onnx"), of_state(&with_memory("state", "m, s, degrees"))).expect("written");
    std::fs::write(at("eye.onnx"), of_colours()).expect("written");
    for name in ["mine", "eye"] {
        let policy = format!("onnx:{name}.onnx");
        for (out, jobs) in [("one", "1"), ("four", "4")] {
            let printed = fly(street.path(), &policy, &["--out", out, "--jobs", jobs]);
            assert_eq!(printed.code, Some(0), "{}", printed.stderr);
        }
        assert_eq!(tree_digests(&at(&format!("one/{name}"))), tree_digests(&at(&format!("four/{name}"))));
        let (result, file) = (format!("one/{name}"), format!("board/{name}.jsonl.zst"));
        let held = format!("{name}.onnx");
        cosfly(&["fly", "bundle", &result, "--out", &file, "--with-policy", &held]).within(street.path()).run_ok();
        let verified = cosfly(&["fly", "verify", &file, "recipe.toml", "--run-policy"]).within(street.path()).run();
        assert_eq!(verified.code, Some(0), "{}{}", verified.stdout, verified.stderr);
        assert!(verified.stdout.contains(&format!("{name}, re-run: 3 of 3 episodes")), "{}", verified.stdout);
    }
    // A policy that the bundle names by its digest alone, beside it; and baselines.
    cosfly(&["fly", "bundle", "one/mine", "--out", "board/named.jsonl.zst"]).within(street.path()).run_ok();
    std::fs::copy(at("mine.onnx"), at("board/named.onnx")).expect("copied");
    for baseline in ["follow", "causal", "expert"] {
        assert_eq!(fly(street.path(), baseline, &["--out", "one"]).code, Some(0));
        let (result, file) = (format!("one/{baseline}"), format!("board/{baseline}.jsonl.zst"));
        cosfly(&["fly", "bundle", &result, "--out", &file]).within(street.path()).run_ok();
    }
    let (printed, table) = board(street.path(), &["--jobs", "4"]);
    assert_eq!(printed.code, Some(0), "{table:#}{}", printed.stderr);
    let suite = &table["suites"][0];
    let classes = suite["rerun"].as_array().expect("a list");
    let classes: Vec<(&str, Vec<&str>)> =
        classes.iter().map(|it| (it["sees"].as_str().expect("words"), files(&it["ranked"]))).collect();
    assert_eq!(classes.iter().map(|it| it.0).collect::<Vec<_>>(), ["rgb", "state", "state, map"], "{table:#}");
    assert_eq!((&classes[0].1[..], classes[1].1.len()), (&["eye"][..], 3), "{table:#}");
    assert_eq!((files(&suite["knows_world"]), files(&suite["ranked"])), (vec!["expert"], vec![]), "{table:#}");
    let page = || std::fs::read(at("board/index.html")).expect("a page");
    let first = page();
    assert!(String::from_utf8_lossy(&first).contains("Re-run, sees state, map"), "the page has the classes");
    board(street.path(), &["--jobs", "1", "--store", "other"]);
    assert_eq!(page(), first, "the same page for any number of threads");
    // Without the option nothing is run: the same entries are re-flown.
    let plain = cosfly(&["leaderboard", "board", "--suite", "recipe.toml"]).within(street.path()).run();
    assert!(plain.code == Some(0) && !plain.stdout.contains("re-run"), "{}{}", plain.stdout, plain.stderr);
}

#[test]
fn actions_of_others_are_no_entry_of_a_colour_policy() {
    let street = Street::new();
    let at = |name: &str| street.path().join(name);
    std::fs::create_dir(at("board")).expect("a folder");
    let eye = OnnxPolicy::of_bytes("eye", of_colours()).expect("a policy");
    for baseline in ["expert", "follow"] {
        assert_eq!(fly(street.path(), baseline, &["--out", "one"]).code, Some(0));
        let mut bundle = Bundle::of(&at(&format!("one/{baseline}"))).expect("a bundle");
        bundle.card.policy = PolicyCard::of_onnx(&eye, "eye", None);
        let bundle = bundle.with_policy(&eye).expect("its digest is on the card");
        std::fs::write(at(&format!("board/{baseline}.jsonl.zst")), bundle.bytes().expect("bytes")).expect("written");
    }
    // The card says that it sees the state alone, its file that it sees colours.
    let mut bundle = Bundle::of(&at("one/follow")).expect("a bundle");
    bundle.card.policy =
        PolicyCard { observations: vec!["state".to_owned()], ..PolicyCard::of_onnx(&eye, "eye", None) };
    let bundle = bundle.with_policy(&eye).expect("its digest is on the card");
    std::fs::write(at("board/other.jsonl.zst"), bundle.bytes().expect("bytes")).expect("written");
    let (printed, table) = board(street.path(), &[]);
    assert_eq!(printed.code, Some(1), "{table:#}");
    let suite = &table["suites"][0];
    assert_eq!(suite["rerun"], json!([]), "{table:#}");
    assert_eq!(files(&suite["knows_world"]), ["expert"], "{table:#}");
    assert_eq!(files(&suite["ranked"]), ["follow", "other"], "{table:#}");
    let differs = |at: usize| suite["ranked"][at]["differs"][0].as_str().unwrap_or_default().to_owned();
    assert!(differs(0).contains("step 1 comes out differently"), "{table:#}");
    assert!(differs(1).contains("says another thing of the policy"), "{table:#}");
    let verify = ["fly", "verify", "board/expert.jsonl.zst", "recipe.toml", "--run-policy"];
    let verified = cosfly(&verify).within(street.path()).run();
    assert!(verified.code == Some(1) && verified.stdout.contains("re-run: 0 of 3"), "{}", verified.stdout);
}

#[test]
fn a_file_that_does_not_fit_is_refused_with_what_is_allowed() {
    let street = Street::new();
    let at = |name: &str| street.path().join(name);
    let good = with_memory("state", "m, s, degrees");
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut described = good.clone();
        change(&mut described);
        of_state(&described)
    };
    let whole = of_state(&good);
    for (bytes, words) in [
        (whole[..whole.len() - 9].to_vec(), "a message is cut off"),
        (b"no network".to_vec(), "an unknown type"),
        (vec![], "it is no ONNX file"),
        (network([&[], &[], &[], &[]], &json!(1)), "invalid type"),
        (changed(&|it| it["version"] = json!(2)), "this cosfly reads 1"),
        (changed(&|it| it["input"] = json!({})), "unknown field `input`, expected one of `version`, `inputs`"),
        (
            changed(&|it| it["inputs"]["seen"]["observation"] = json!("stat")),
            "did you mean `state`? Allowed are state, rgb",
        ),
        (changed(&|it| it["inputs"]["seen"]["unit"] = json!("feet")), "allowed is \"m, s, degrees\""),
        (changed(&|it| it["inputs"]["seen"]["observation"] = json!("depth")), "allowed is \"m\""),
        (changed(&|it| it["inputs"]["seen"]["history"] = json!(2)), "`state` has 16 numbers, 2 times"),
        (changed(&|it| it["inputs"] = json!({})), "its input `seen`: its description names it neither"),
        (changed(&|it| it["states"]["h"] = json!("actions")), "names the input `h`; the network has seen, memory"),
        (changed(&|it| it["states"]["memory"] = json!("now")), "names the output `now`; the network has actions"),
        (changed(&|it| it["output"]["actions"] = json!("speed")), "allowed actions are velocity, thrust-rates"),
        (changed(&|it| it["output"]["actions"] = json!("rotors")), "that of rotors is \"rev/min, degrees/s\""),
        (changed(&|it| it["every"] = json!(0)), "`every` is 0; it must be 1 to 1000"),
        (changed(&|it| it["look"] = json!("plain")), "allowed are simple, full"),
        (
            network(
                [
                    &[node("Identity", &["memory"], "actions")],
                    &[],
                    &[port("memory", &[1, 5])],
                    &[port("actions", &[1, 5])],
                ],
                &json!({ "version": 1, "inputs": {}, "output": good["output"], "states": good["states"] }),
            ),
            "it sees nothing",
        ),
        (
            network(
                [
                    &[node("Identity", &["seen"], "actions")],
                    &[],
                    &[port("seen", &[5])],
                    &[port("actions", &[5]), port("actions", &[5])],
                ],
                &good,
            ),
            "two of its outputs have one name",
        ),
        (
            network([&[node("Loop", &[], "actions")], &[], &[], &[port("actions", &[1, 5])]], &good),
            "`actions` (Loop) has an operator that is not read; allowed are Abs, Add",
        ),
        (
            network(
                [
                    &[node("MatMul", &["seen", "weights"], "actions")],
                    &[constant("weights", &[3, 5], &[0.0; 15])],
                    &[port("seen", &[1, 16])],
                    &[port("actions", &[1, 5])],
                ],
                &description("state", "m, s, degrees"),
            ),
            "the node `actions` (MatMul): it multiplies the shapes [1, 16] and [3, 5]",
        ),
    ] {
        std::fs::write(at("bad.onnx"), bytes).expect("written");
        let printed = fly(street.path(), "onnx:bad.onnx", &[]);
        let told = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(printed.code == Some(4) && told.contains(words), "{words}: {}", printed.stderr);
        assert!(told.contains("error[fly-onnx]") && !at("out/fly").exists(), "{words}: {}", printed.stderr);
    }
    std::fs::create_dir(at("folder.onnx")).expect("made");
    for (policy, words) in [("onnx:absent.onnx", "there is no such file"), ("onnx:folder.onnx", "it is no file")] {
        let printed = fly(street.path(), policy, &[]);
        assert!(printed.code == Some(4) && printed.stderr.contains(words), "{words}: {}", printed.stderr);
    }
    std::fs::write(at("good.onnx"), whole).expect("written");
    let printed = fly(street.path(), "onnx:good.onnx", &["--obs", "depth"]);
    assert!(printed.code == Some(3) && printed.stderr.contains("`--obs` says how"), "{}", printed.stderr);
    // Another policy's bundle.
    assert_eq!(fly(street.path(), "onnx:good.onnx", &["--out", "one"]).code, Some(0));
    std::fs::write(at("eye.onnx"), of_colours()).expect("written");
    let other = cosfly(&["fly", "bundle", "one/good", "--with-policy", "eye.onnx"]).within(street.path()).run();
    assert!(other.code == Some(3) && other.stderr.contains("is not the policy that flew"), "{}", other.stderr);
    cosfly(&["fly", "bundle", "one/good", "--out", "named.jsonl.zst"]).within(street.path()).run_ok();
    let verify = ["fly", "verify", "named.jsonl.zst", "recipe.toml", "--run-policy"];
    let refused = cosfly(&verify).within(street.path()).run();
    assert!(refused.code == Some(4) && refused.stderr.contains("by its digest alone"), "{}", refused.stderr);
    let verify = [&verify[..], &["--policy-file", "good.onnx"]].concat();
    cosfly(&verify).within(street.path()).run_ok();
}

#[test]
fn the_policies_that_ship_fly_and_their_card_names_them() {
    let street = Street::new();
    let folder = repository_root().join("recipes/policies");
    let card = std::fs::read_to_string(folder.join("README.md")).expect("a card");
    // Each row of the card's table is of a file, and each file has a row with its digest.
    let rows: Vec<&str> = card.lines().filter(|line| line.starts_with("| `") && line.contains(".onnx` |")).collect();
    let files = std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let files: Vec<_> = files.filter(|file| file.extension().is_some_and(|it| it == "onnx")).collect();
    assert_eq!(rows.len(), files.len(), "{files:?}");
    for file in files {
        let name = file.file_stem().and_then(|it| it.to_str()).expect("UTF-8");
        let row = rows.iter().find(|row| row.starts_with(&format!("| `{name}.onnx` |"))).expect("a row");
        assert!(std::fs::metadata(&file).expect("shipped").len() < 5_000_000);
        let printed = fly(street.path(), &format!("onnx:{}", file.display()), &["--out", "shipped"]);
        assert_eq!(printed.code, Some(0), "{}", printed.stderr);
        let flown = std::fs::read(street.path().join("shipped").join(name).join("card.json")).expect("a card");
        let flown: Value = serde_json::from_slice(&flown).expect("JSON");
        let digest = flown["policy"]["source"].as_str().expect("a digest");
        assert!(row.contains(digest), "`{name}` is {digest}, which its card does not say");
    }
}
