//! Texts generated from the kinds: the recipe schema, the reference page, drawings of the graph.

use crate::toys::{WHOLE, check, registry};
use cosfly_recipe::{DrawingFormat, graph, reference, schema};

#[test]
fn the_graph_as_mermaid() {
    insta::assert_snapshot!(graph(&check(WHOLE, &[]).unwrap(), DrawingFormat::Mermaid), @r#"
    flowchart TD
        s0["town<br/>map, 1 item"]
        s1["people<br/>walkers, 3 items"]
        s2["expert<br/>expert, 3 items"]
        s3["second<br/>expert, 3 items"]
        s4["frames<br/>render, 6 items"]
        s5["tables.logs<br/>dataset, 6 items"]
        s6["tables<br/>dataset, 1 item"]
        s0 --> s1
        s0 --> s2
        s1 -->|target| s2
        s0 --> s3
        s1 -->|target| s3
        s0 --> s4
        s2 -->|trajectories| s4
        s3 -->|trajectories| s4
        s4 --> s5
        s4 --> s6
        s5 -->|logs| s6
    "#);
}

#[test]
fn the_graph_as_dot() {
    insta::assert_snapshot!(graph(&check(WHOLE, &[]).unwrap(), DrawingFormat::Dot), @r#"
    digraph "whole" {
        rankdir=TB;
        node [shape=box, style=rounded, fontname="sans-serif"];
        edge [fontname="sans-serif", fontsize=10];
        "town" [label="town\nmap, 1 item"];
        "people" [label="people\nwalkers, 3 items"];
        "expert" [label="expert\nexpert, 3 items"];
        "second" [label="second\nexpert, 3 items"];
        "frames" [label="frames\nrender, 6 items"];
        "tables.logs" [label="tables.logs\ndataset, 6 items"];
        "tables" [label="tables\ndataset, 1 item"];
        "town" -> "people";
        "town" -> "expert";
        "people" -> "expert" [label="target"];
        "town" -> "second";
        "people" -> "second" [label="target"];
        "town" -> "frames";
        "expert" -> "frames" [label="trajectories"];
        "second" -> "frames" [label="trajectories"];
        "frames" -> "tables.logs";
        "frames" -> "tables";
        "tables.logs" -> "tables" [label="logs"];
    }
    "#);
}

#[test]
fn the_reference_of_a_kind() {
    let page = reference(&registry());
    let (_, kind) = page.split_once("\n## `walkers`").unwrap();
    insta::assert_snapshot!(kind, @r#"
    People who walk.

    | input | takes | items | meaning |
    |---|---|---|---|
    | `town` | `town/1` | its one item, for all | The town. |

    | parameter | type | default | range | meaning |
    |---|---|---|---|---|
    | `colour` | a list of whole numbers | none | exactly `3` entries, each at least `0`, at most `255` | A colour as red, green, blue. |
    | `count` | a whole number | `4` | at least `1` | Number of paths. Asking for more renames none. |
    | `crossing` | a string | `"free"` | `free`, `zebra_only` | Places where streets are crossed.<br>`free`: Anywhere.<br>`zebra_only`: Only where the ground is painted. |
    | `crowd` | a string | `"people"` | characters: at least `1` | Name of the crowd. |
    | `curious` | `true` or `false` | `false` |  | True for people who look around. |
    | `margin_m` | a number | `0.5` | at least `0` | Distance kept from obstacles. |
    | `pause` | a table | `{ kind = "none" }` | `kind`: `none`, `random` | Stops on the way. |
    | `pause(kind = random).chance` | a number | required | at least `0`, at most `1` | Chance of a stop per second. |
    | `shares` | a table | `{}` |  | Shares by age. |
    | `speed` | a table |  |  | Walking speed. |
    | `speed.max_mps` | a number | `2` | at most `10` | Fastest speed. Not below the slowest. |
    | `speed.min_mps` | a number | `0.5` | greater than `0` | Slowest speed. |
    | `version` | a string | `"1.0"` | matches `^[0-9]+\.[0-9]+$` | Version of the crowd, such as `1.0`. |
    | `visits` | a list of tables | `[]` | at most `3` entries | Waypoints that every path visits. |
    | `visits[].max_mps` | a number | `2` | at most `10` | Fastest speed. Not below the slowest. |
    | `visits[].min_mps` | a number | `0.5` | greater than `0` | Slowest speed. |

    ## `weathers`

    Draws each trajectory in several weathers.

    | input | takes | items | meaning |
    |---|---|---|---|
    | `trajectories` | one or more of `trajectory/1` | item by item | What is shown. |
    | `also` | one or more of `trajectory/1`, optional | item by item | What is shown. |

    No parameters.
    "#);
}

#[test]
fn the_schema_of_a_kind() {
    let schema = schema(&registry());
    let kind = serde_json::to_string_pretty(&schema["$defs"]["map"]).unwrap();
    insta::assert_snapshot!(kind, @r#"
    {
      "additionalProperties": false,
      "description": "Reads a town.",
      "properties": {
        "source": {
          "description": "The town's file.",
          "minLength": 1,
          "type": "string"
        },
        "use": {
          "const": "map",
          "description": "Reads a town."
        }
      },
      "required": [
        "use",
        "source"
      ],
      "type": "object"
    }
    "#);
}

#[test]
fn the_schema_offers_every_kind_and_refers_only_to_what_is_there() {
    let schema = schema(&registry());
    let rules = schema["$defs"]["stage"]["then"]["allOf"].as_array().unwrap();
    assert_eq!(rules.len(), registry().iter().count());
    let text = schema.to_string();
    for piece in text.split("\"$ref\":\"#").skip(1) {
        let pointer = piece.split('"').next().unwrap();
        assert!(schema.pointer(pointer).is_some(), "{pointer}");
    }
}
