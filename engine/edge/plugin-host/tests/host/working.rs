//! Plugins that do what they should.

use crate::fixtures::{TermText, component, costs_of, flight};
use cosfly_plugin_host::{Host, Kind, PluginLimits};

#[test]
fn a_core_module_of_a_compiler_that_knows_no_interface_is_a_cost_term() {
    let plugin = TermText::default().load().unwrap();
    assert_eq!((plugin.kind, plugin.metadata.name.as_str()), (Kind::CostTerm, "square"));
    let costs = costs_of(&plugin, &flight(5)).unwrap();
    assert_eq!(costs, [9.0, 4.0, 1.0, 0.0, 1.0]);
}

#[test]
fn strict_mode_gives_the_same_costs() {
    let bytes = TermText::default().bytes();
    let limits = PluginLimits { fuel: 100_000, ..PluginLimits::default() };
    let plugin = Host::new(None).load_bytes(&bytes, "square.wasm", None, limits).unwrap();
    assert_eq!(costs_of(&plugin, &flight(5)).unwrap(), [9.0, 4.0, 1.0, 0.0, 1.0]);
}

#[test]
fn compiled_code_is_kept_and_damaged_code_is_made_anew() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = TermText::default().bytes();
    let load = || {
        let host = Host::new(Some(folder.path().join("kept")));
        host.load_bytes(&bytes, "square.wasm", Some(Kind::CostTerm), PluginLimits::default()).unwrap()
    };
    load();
    let kept: Vec<_> = std::fs::read_dir(folder.path().join("kept")).unwrap().map(|it| it.unwrap().path()).collect();
    assert_eq!(kept.len(), 1);
    let good = std::fs::read(&kept[0]).unwrap();
    for damaged in [&good[..20], &good[..good.len() / 2], b"", b"\x7fELF and nothing"] {
        std::fs::write(&kept[0], damaged).unwrap();
        assert_eq!(costs_of(&load(), &flight(2)).unwrap(), [9.0, 4.0]);
        assert_eq!(std::fs::read(&kept[0]).unwrap(), good);
    }
}

#[test]
fn another_track_is_told_again() {
    let plugin = TermText::default().load().unwrap();
    for frames in [1, 2, 9] {
        assert_eq!(costs_of(&plugin, &flight(frames)).unwrap().len(), frames);
    }
}

#[test]
fn a_module_and_the_component_around_it_give_the_same_bits() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../recipes/plugins");
    let mut tried = 0;
    for name in ["no_fly_zone", "privacy", "sun_glare", "wind"] {
        let bytes = std::fs::read(folder.join(format!("{name}.wasm"))).unwrap();
        let component = component(bytes.clone()).expect("it is a cost term");
        let flight = flight(50);
        let both = [bytes, component].map(|bytes| {
            let plugin = Host::new(None).load_bytes(&bytes, name, None, PluginLimits::default()).unwrap();
            let costs = costs_of(&plugin, &flight).unwrap();
            (plugin.metadata.clone(), costs.iter().map(|cost| cost.to_bits()).collect::<Vec<_>>())
        });
        assert_eq!(both[0], both[1], "{name}");
        tried += 1;
    }
    assert_eq!(tried, 4);
}
