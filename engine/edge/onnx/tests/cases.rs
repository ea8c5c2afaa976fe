//! The law of operators: each gives the numbers of ONNX's reference evaluator, and the same bits on every machine.
//!
//! `tests/outside/make_onnx_cases.py` makes the cases.

use cosfly_fingerprint::Digest;
use cosfly_onnx::{OPERATORS, OnnxModel, Tensor, TensorValues};
use serde_json::Value;
use std::path::Path;

/// Digest of the bits of all outputs.
const BITS: &str = "02bc7ec63ff288b3d09b0d59359692cd5c3c4ce1cb203315b7457e97670b81e4";

fn tensor(told: &Value) -> Tensor {
    let list = |name: &str| told[name].as_array();
    let shape: Vec<usize> =
        list("shape").expect("a shape").iter().map(|it| it.as_u64().expect("a size") as usize).collect();
    match list("floats") {
        Some(floats) => Tensor::floats(&shape, floats.iter().map(|it| it.as_f64().expect("a number") as f32).collect()),
        None => {
            let wholes = list("wholes").expect("numbers");
            Tensor::wholes(&shape, wholes.iter().map(|it| it.as_i64().expect("a number")).collect())
        }
    }
}

fn is_near(ours: &Tensor, theirs: &Tensor) -> bool {
    let near = |(ours, theirs): (&f32, &f32)| (ours - theirs).abs() <= 2e-6 * theirs.abs().max(1.0);
    ours.shape == theirs.shape
        && match (&ours.values, &theirs.values) {
            (TensorValues::Floats(ours), TensorValues::Floats(theirs)) => ours.iter().zip(theirs).all(near),
            (ours, theirs) => ours == theirs,
        }
}

#[test]
fn every_operator_gives_the_numbers_of_the_reference_and_the_same_bits_everywhere() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases");
    let mut paths: Vec<_> = folder.read_dir().expect("cases").map(|it| it.expect("readable").path()).collect();
    paths.sort();
    let (mut tested, mut bits) = (vec![], vec![]);
    for path in paths {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let model =
            OnnxModel::read(&std::fs::read(&path).expect("readable")).unwrap_or_else(|what| panic!("{name}: {what}"));
        let case: Value = serde_json::from_str(model.metadata("case").expect("a case")).expect("JSON");
        let tensors = |name: &str| case[name].as_array().expect("a list").iter().map(tensor).collect::<Vec<Tensor>>();
        let made = model.run(tensors("inputs")).unwrap_or_else(|what| panic!("{name}: {what}"));
        let wanted = tensors("outputs");
        assert_eq!(made.len(), wanted.len(), "{name}");
        for (ours, theirs) in made.iter().zip(&wanted) {
            assert!(is_near(ours, theirs), "{name}: {ours:?} instead of {theirs:?}");
            match &ours.values {
                TensorValues::Floats(values) => bits.extend(values.iter().flat_map(|value| value.to_le_bytes())),
                TensorValues::Wholes(values) => bits.extend(values.iter().flat_map(|value| value.to_le_bytes())),
            }
        }
        tested.extend(OPERATORS.iter().filter(|it| name.replace('_', "").starts_with(&it.name.to_lowercase())));
    }
    let missing = OPERATORS.iter().find(|it| tested.iter().all(|tested| tested.name != it.name));
    assert!(missing.is_none(), "{missing:?} has no case");
    assert_eq!(Digest::of(&bits).to_string(), BITS, "other bits than on the machine that held them");
}
