//! Extracts of OpenStreetMap beside the repository. The counts are those of pyosmium (`tests/outside/check_osm.py`).

use cosfly_domain::ObstacleKind;
use cosfly_geodata::osm::{OpenStreetMap, OsmOptions};
use cosfly_town::{Format, MapFormat};
use std::collections::BTreeSet;

#[path = "../../../../tests/shared.rs"]
mod shared;

#[test]
fn every_extract_reads_with_all_its_buildings() {
    let Some(folder) = shared::shared_input("osm") else { return };
    for (name, buildings) in [
        ("Laufamholzstrasse.osm.xml", 118),
        ("bayfront_singapore.osm.pbf", 31),
        ("berlin-siegessaeule.osm.gz", 5),
        ("helsinki_center.osm.pbf", 452),
        ("helsinki_region_test.osm.pbf", 2171),
        ("krems.osm.gz", 1195),
        ("map-sidewalk-no.osm.gz", 132),
        ("monaco.osm.pbf", 1205),
        ("paris_bss.osm.pbf", 7),
    ] {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        assert!(OpenStreetMap::recognises(&bytes[..bytes.len().min(Format::HEAD_BYTES)]), "{name}");
        let (mut town, _) = OpenStreetMap::read(&bytes, &OsmOptions::default()).unwrap();
        town.update_bounds();
        town.assert_well_formed().unwrap();
        let own = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building);
        assert_eq!(own.map(|one| one.object_id).collect::<BTreeSet<_>>().len(), buildings, "{name}");
        assert!(town.walkable.iter().any(|area| !area.synthetic), "{name}");
    }
}
