//! Splats and meshes of scans through the real binary: drawn, checked, cached by what their file holds, refused where they mean nothing.

use crate::street::{RECIPE, Street, map};
use crate::support::cosfly;
use cosfly_models::mesh::TexturedMesh;
use cosfly_read::PublishedDataset;
use cosfly_splats::{Splat, to_ply};

/// A splat in yellow.
const YELLOW: [f32; 3] = [1.0, 0.9, 0.1];

/// The street whose render stage has these lines.
fn street(lines: &str) -> Street {
    let changed = RECIPE.replacen("width = 96\n", &format!("width = 96\n{lines}\n"), 1);
    let street = Street::with(&changed, &map());
    let places = (-15..15).flat_map(|x| (-15..15).map(move |y| [4.0 * x as f32, 4.0 * y as f32, 0.0]));
    let splat = |middle| Splat::plain(middle, [2.0, 2.0, 0.02], [1.0, 0.0, 0.0, 0.0], 0.9, YELLOW);
    let splats: Vec<Splat> = places.map(splat).collect();
    std::fs::write(street.path().join("street.ply"), to_ply(&splats, "street.xodr")).expect("writable");
    street
}

#[test]
fn splats_are_drawn_over_the_town_and_the_dataset_holds() {
    let street = street("weathers = [\"ClearNoon\"]\nsplats = { source = \"street.ply\", up_axis = \"z\" }");
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run_ok();
    assert!(!printed.stderr.contains("the splats lie"), "{}", printed.stderr);
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();

    // The same file elsewhere makes nothing anew; another place of it makes other pictures.
    std::fs::rename(street.path().join("street.ply"), street.path().join("scan.ply")).expect("movable");
    let frames_made = |splats: &str| {
        let set = format!("stages.frames.splats={splats}");
        let printed = cosfly(&["run", "recipe.toml", "--json", "--set", &set]).within(street.path()).run_ok();
        let summary: serde_json::Value = serde_json::from_str(&printed.stdout).expect("a JSON summary");
        let stages = summary["stages"].as_array().expect("stages").clone();
        stages.into_iter().find(|it| it["stage"] == "frames").expect("the stage")["ran"].as_u64().expect("a count")
    };
    assert_eq!(frames_made("{ source = \"scan.ply\", up_axis = \"z\" }"), 0);
    assert_eq!(frames_made("{ source = \"scan.ply\", up_axis = \"z\", turn_deg = 30 }"), 6);

    // Splats far below the street are not those of the street.
    let set = "stages.frames.splats={ source = \"scan.ply\", up_axis = \"z\", origin_m = [0, 0, -9] }";
    let printed = cosfly(&["run", "recipe.toml", "--set", set]).within(street.path()).run_ok();
    assert!(printed.stderr.contains("the splats lie"), "{}", printed.stderr);
}

#[test]
fn scans_that_cannot_be_drawn_are_refused_before_anything_runs() {
    let dry = "weathers = [\"ClearNoon\"]\n";
    let lines = |keys: &str| format!("{dry}splats = {{ {keys} }}");
    for (lines, code, words) in [
        (lines("source = \"street.xodr\", up_axis = \"z\""), 4, vec!["street.xodr", ".spz", "recipe.toml:"]),
        (lines("source = \"none.ply\", up_axis = \"z\""), 4, vec!["none.ply", "recipe.toml:"]),
        (lines("source = \"street.ply\""), 3, vec!["up_axis"]),
        (lines("source = \"street.ply\", up_axis = \"x\""), 3, vec!["x", "-y"]),
        (lines("source = \"street.ply\", up_axis = \"z\", unit_m = 0"), 3, vec!["unit_m", "0.0001"]),
        (
            "weathers = [\"WetNoon\"]\nsplats = { source = \"street.ply\", up_axis = \"z\" }".to_owned(),
            3,
            vec!["WetNoon", "ClearNoon, CloudyNoon, ClearSunset, CloudySunset", "recipe.toml:"],
        ),
        (
            format!("season = \"winter\"\n{}", lines("source = \"street.ply\", up_axis = \"z\"")),
            3,
            vec!["season", "those of the scan"],
        ),
    ] {
        let street = street(&lines);
        let printed = cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run();
        assert_eq!(printed.code, Some(code), "{lines}: {}", printed.stderr);
        for word in words {
            assert!(printed.stderr.contains(word), "{word}: {}", printed.stderr);
        }
        assert!(!street.dataset().exists());
    }
}

/// The street as an example's mesh, drawn as it is.
fn meshed(keys: &str) -> Street {
    let lines = format!("width = 96\nweathers = [\"ClearNoon\"]\nmesh = {{ {keys} }}\n");
    let changed = RECIPE.replacen("width = 96\n", &lines, 1).replacen("street.xodr", "scan.glb", 1);
    let street = Street::with(&changed, &map());
    std::fs::write(street.path().join("scan.glb"), TexturedMesh::EXAMPLE).expect("writable");
    std::fs::write(street.path().join("scan.obj"), "mtllib scan.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n")
        .expect("writable");
    std::fs::write(street.path().join("scan.mtl"), "newmtl stone\n").expect("writable");
    street
}

#[test]
fn a_mesh_is_drawn_as_it_is_and_its_licence_stands_on_the_card() {
    let street = meshed("source = \"scan.glb\", license = \"CC BY 4.0, Ana Kos\", faces_and_plates = \"removed\"");
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run_ok();
    for words in ["licence of the scan", "number plates", "of the mesh lie"] {
        assert!(!printed.stderr.contains(words), "{words}: {}", printed.stderr);
    }
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    let card = std::fs::read_to_string(dataset.join("README.md")).expect("a card");
    assert!(card.contains("CC BY 4.0, Ana Kos") && card.contains("number plates: removed"), "{card}");

    // Elsewhere, the mesh is not that of the map; without a licence, somebody must ask.
    let set = "stages.frames.mesh={ source = \"scan.glb\", origin_m = [0, 0, -30] }";
    let air = "stages.frames.weather={ fog_density = [40, 40], precipitation = [50, 50] }";
    let printed = cosfly(&["run", "recipe.toml", "--set", set, "--set", air]).within(street.path()).run_ok();
    let card = std::fs::read_to_string(dataset.join("README.md")).expect("a card");
    assert!(card.contains("its ground stays dry") && card.contains("number plates: not stated"), "{card}");
    for words in ["of the mesh lie", "licence of the scan", "mesh.license", "mesh.faces_and_plates"] {
        assert!(printed.stderr.contains(words), "{words}: {}", printed.stderr);
    }
    // Nights are shown where the weather lights the mesh, and nowhere else.
    let night = "stages.frames.weathers=[\"ClearNight\"]";
    let lit = "stages.frames.mesh={ source = \"scan.glb\", light = \"weather\" }";
    let printed = cosfly(&["plan", "recipe.toml", "--set", night]).within(street.path()).run();
    assert!(
        printed.code == Some(3) && printed.stderr.contains("`ClearNight` is wet, dusty or dark"),
        "{}",
        printed.stderr
    );
    cosfly(&["run", "recipe.toml", "--set", lit, "--set", night]).within(street.path()).run_ok();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    let card = std::fs::read_to_string(dataset.join("README.md")).expect("a card");
    assert!(card.contains("its light is that of each picture's weather"), "{card}");
    let printed = cosfly(&["map", "inspect", "scan.glb"]).within(street.path()).run_ok();
    assert!(printed.stdout.contains("52 triangles, 2 pictures of up to 32 x 32 pixels"), "{}", printed.stdout);
}

#[test]
fn meshes_that_cannot_be_drawn_are_refused_before_anything_runs() {
    for (keys, code, words) in [
        ("source = \"street.xodr\"", 4, vec!["street.xodr", "neither glTF nor OBJ", "recipe.toml:"]),
        ("source = \"none.glb\"", 4, vec!["none.glb", "recipe.toml:"]),
        ("source = \"scan.obj\"", 4, vec!["scan.mtl", "`files`", "recipe.toml:"]),
        ("source = \"scan.glb\", unit_m = 0", 3, vec!["unit_m", "recipe.toml:"]),
        ("source = \"scan.glb\", up_axis = \"x\"", 3, vec!["up_axis", "recipe.toml:"]),
        ("source = \"scan.glb\", exposure_ev = 9", 3, vec!["exposure_ev", "recipe.toml:"]),
        ("source = \"scan.glb\", light = \"moon\"", 3, vec!["`scan`", "`weather`", "recipe.toml:"]),
        ("source = \"scan.glb\", faces_and_plates = \"some\"", 3, vec!["removed", "readable", "recipe.toml:"]),
    ] {
        let street = meshed(keys);
        let printed = cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run();
        assert_eq!(printed.code, Some(code), "{keys}: {}", printed.stderr);
        for word in words {
            assert!(printed.stderr.contains(word), "{keys}: {word}: {}", printed.stderr);
        }
    }
    let street = meshed("source = \"scan.obj\", files = [\"scan.mtl\"]");
    let printed = cosfly(&["plan", "recipe.toml"]).within(street.path()).run_ok();
    assert!(!printed.stdout.is_empty());
}

#[test]
fn a_town_is_converted_to_a_mesh_and_to_splats_that_lie_where_it_lies() {
    let street = Street::with(&RECIPE.replacen("width = 96\n", "width = 96\nweathers = [\"ClearNoon\"]\n", 1), &map());
    for (out, key) in [
        ("town.glb", "mesh = { source = \"town.glb\" }"),
        ("town.ply", "splats = { source = \"town.ply\", up_axis = \"z\" }"),
    ] {
        let convert = ["map", "convert", "street.xodr", "--out", out, "--texel-m", "0.5"];
        let printed = cosfly(&convert).within(street.path()).run_ok();
        assert!(printed.stdout.contains(key), "{}", printed.stdout);
        let set = format!("stages.frames.{key}");
        let printed = cosfly(&["run", "recipe.toml", "--set", &set]).within(street.path()).run_ok();
        for words in ["the splats lie", "of the mesh lie", "comes within"] {
            assert!(!printed.stderr.contains(words), "{}", printed.stderr);
        }
    }
    for (arguments, code, words) in [
        (["--out", "town.obj", "--texel-m", "0.5"], 2, ".glb"),
        (["--out", "town.glb", "--texel-m", "5"], 3, "0.02 to 1"),
        (["--out", "town.ply", "--texel-m", "0.02"], 3, "bounds_m"),
        (["--out", "nowhere/town.ply", "--texel-m", "1"], 5, "nowhere"),
    ] {
        let all = [&["map", "convert", "street.xodr"], &arguments[..]].concat();
        let printed = cosfly(&all).within(street.path()).run();
        assert_eq!(printed.code, Some(code), "{arguments:?}: {}", printed.stderr);
        assert!(printed.stderr.contains(words), "{arguments:?}: {}", printed.stderr);
    }
}

/// Writes a tileset of these tiles into the street.
fn tileset(street: &Street, uris: &[&str]) {
    let leaf = |uri: &&str| format!(r#"{{"geometricError":0,"content":{{"uri":"{uri}"}}}}"#);
    let children = uris.iter().map(leaf).collect::<Vec<_>>().join(",");
    let root = format!(r#"{{"geometricError":9,"refine":"REPLACE","children":[{children}]}}"#);
    let text = format!(r#"{{"asset":{{"version":"1.1"}},"geometricError":9,"root":{root}}}"#);
    std::fs::write(street.path().join("tiles/tileset.json"), text).expect("writable");
}

#[test]
fn tiles_become_one_mesh_and_nothing_beyond_their_folder_is_opened() {
    let street = meshed("source = \"scan.glb\", license = \"mine\"");
    let folder = street.path().join("tiles");
    std::fs::create_dir(&folder).expect("a folder");
    std::fs::rename(street.path().join("scan.glb"), folder.join("0.glb")).expect("movable");
    std::fs::write(street.path().join("secret.glb"), TexturedMesh::EXAMPLE).expect("writable");
    tileset(&street, &["0.glb"]);
    let join = |more: &[&str]| {
        let all = [&["map", "tiles", "tiles/tileset.json", "--out", "scan.glb"], more].concat();
        cosfly(&all).within(street.path()).run()
    };
    // A pixel 5,760 m away is as large as the error of the coarse tile.
    let plain = std::fs::read_to_string(folder.join("tileset.json")).expect("text");
    let coarse = plain.replace(r#""refine""#, r#""content":{"uri":"0.glb"},"refine""#);
    std::fs::write(folder.join("tileset.json"), coarse).expect("writable");
    for (near, words) in [("--near-m=5700", "true to 0 m"), ("--near-m=5800", "true to 9 m")] {
        let printed = join(&[near]);
        assert!(printed.stdout.contains(words), "{near}: {}{}", printed.stdout, printed.stderr);
    }
    tileset(&street, &["0.glb"]);
    let printed = join(&[]);
    assert!(printed.code == Some(0) && printed.stdout.contains("1 tile of 1 tileset,"), "{}", printed.stderr);
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run_ok();
    for words in ["of the mesh lie", "comes within"] {
        assert!(!printed.stderr.contains(words), "{}", printed.stderr);
    }
    let set = ["run", "recipe.toml", "--set", "stages.town.source=tiles/tileset.json"];
    let printed = cosfly(&set).within(street.path()).run();
    assert!(printed.code == Some(4) && printed.stderr.contains("cosfly map tiles"), "{}", printed.stderr);
    #[cfg(unix)]
    std::os::unix::fs::symlink("../secret.glb", folder.join("link.glb")).expect("a link");
    for (uri, words) in [
        ("../secret.glb", "leads out"),
        ("https://example.org/0.glb", "an address"),
        ("none.glb", "cannot be read"),
        ("tileset.json", "nested deeper"),
        #[cfg(unix)]
        ("link.glb", "beyond the tileset's folder"),
    ] {
        tileset(&street, &[uri]);
        let printed = join(&[]);
        assert_eq!(printed.code, Some(4), "{uri}: {}", printed.stderr);
        assert!(printed.stderr.contains(words) && printed.stderr.contains("help: "), "{uri}: {}", printed.stderr);
    }
    for (more, words) in [
        ("--error-m=-1", "0 to 1000"),
        ("--near-m=-1", "`--near-m` is `-1`"),
        ("--area-m=1,1,0,2", "west"),
        ("--area-m=1,2", "four"),
        ("--origin=91,0,0", "latitude"),
    ] {
        let printed = join(&[more]);
        assert!(printed.code == Some(3) && printed.stderr.contains(words), "{more}: {}", printed.stderr);
    }
}

#[test]
fn finished_flights_are_held_against_the_mesh_and_a_planted_triangle_is_found() {
    let street = meshed("source = \"scan.glb\", license = \"mine\"");
    cosfly(&["run", "recipe.toml"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    let shown = dataset.to_str().expect("UTF-8");
    let verify = |more: &[&str]| cosfly(&[&["verify", shown], more].concat()).within(street.path()).run();
    let printed = verify(&["--mesh", "scan.glb"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stdout);
    assert!(printed.stdout.contains("flights held against the mesh"), "{}", printed.stdout);

    // A hand's width of a wall half a metre beside one point of one flight, in no box of the map.
    let published = PublishedDataset::open(&dataset).expect("a dataset");
    let flight = &published.flights()[0];
    let index = published.row_index("frames").expect("an index");
    let frame = &published.frames(&index, flight).expect("frames")[5];
    let at = frame.pose.position_in_world + flight.town_offset_m;
    let corner = |aside: f64, up: f64| format!("v {} {} {}\n", at.x + 0.5, at.z + up, at.y + aside);
    let wall = [corner(0.0, 0.0), corner(0.1, 0.0), corner(0.0, 0.1), "f 1 2 3\n".to_owned()].concat();
    // Its materials lie in a folder beside it, and nobody names them.
    std::fs::create_dir(street.path().join("looks")).expect("writable");
    std::fs::write(street.path().join("looks/wall.mtl"), "newmtl wall\n").expect("writable");
    let wall = format!("mtllib looks/wall.mtl\nusemtl wall\n{wall}");
    std::fs::write(street.path().join("wall.obj"), wall).expect("writable");
    let printed = verify(&["--mesh", "wall.obj"]);
    assert_eq!(printed.code, Some(1), "{}", printed.stdout);
    let named = format!("`{}` frame", flight.trajectory_id);
    for words in ["[verify-mesh]", "comes within 0.", &named] {
        assert!(printed.stdout.contains(words), "{words}: {}", printed.stdout);
    }
    let doctor = |more: &[&str]| cosfly(&[&["doctor", shown, "--mesh"], more].concat()).within(street.path()).run();
    let printed = doctor(&["wall.obj"]);
    assert_eq!(printed.code, Some(1), "{}", printed.stdout);
    for words in ["[scan-clearance]", "[scan-ground]", &flight.trajectory_id] {
        assert!(printed.stdout.contains(words), "{words}: {}", printed.stdout);
    }
    let printed = doctor(&["scan.glb"]);
    assert!(!printed.stdout.contains("[scan-"), "{}{}", printed.stdout, printed.stderr);
    // A scan that lies two metres too high.
    let printed = doctor(&["scan.glb", "--mesh-set", "origin_m=[0, 0, 2]"]);
    assert!(
        printed.code == Some(1) && printed.stdout.contains("under the mesh in the median [scan-ground]"),
        "{}",
        printed.stdout
    );
    let printed = doctor(&["none.glb"]);
    assert!(printed.code == Some(4) && printed.stderr.contains("none.glb"), "{}", printed.stderr);
    // Far away it hurts nobody.
    let printed = verify(&["--mesh", "wall.obj", "--mesh-set", "origin_m=[0, 0, 300]"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stdout);
    for (more, words) in [("origin_m", "no key"), ("up=z", "up_axis")] {
        let printed = verify(&["--mesh", "scan.glb", "--mesh-set", more]);
        assert!(printed.code == Some(3) && printed.stderr.contains(words), "{more}: {}", printed.stderr);
    }
    let printed = verify(&["--mesh", "scan.glb", "--mesh-town", "elsewhere"]);
    assert!(printed.code == Some(3) && printed.stderr.contains("--mesh-town"), "{}", printed.stderr);
}

#[test]
fn fly_draws_the_scan_of_the_recipe_and_tells_other_scans_apart() {
    let street = meshed("source = \"scan.glb\", license = \"CC BY 4.0, Ana Kos\"");
    let fly = |out: &str, mesh: &str| {
        let set = format!("stages.frames.mesh={{ source = \"scan.glb\"{mesh} }}");
        let arguments = ["fly", "recipe.toml", "--policy", "hold", "--clips", "1", "--out", out, "--set", &set];
        let printed = cosfly(&arguments).within(street.path()).run();
        let clips = std::fs::read_dir(street.path().join(out).join("hold/clips")).expect("clips");
        let clip = clips.map(|clip| std::fs::read(clip.expect("readable").path()).expect("readable")).next();
        (printed.code, printed.stderr, clip.expect("a clip"))
    };
    let (code, errors, as_it_is) = fly("plain", "");
    assert_eq!(code, Some(0), "{errors}");
    let (code, errors, bright) = fly("bright", ", exposure_ev = 3");
    assert_eq!(code, Some(0), "{errors}");
    assert!(as_it_is != bright, "the clips show the mesh");
    let (code, errors, _) = fly("plain", ", exposure_ev = 3");
    assert_eq!(code, Some(3), "{errors}");
    assert!(errors.contains("another evaluation"), "{errors}");
}
