//! Parts of a stage that are omitted where the recipe omits their inputs.

use crate::toys::{ToyStage, port};
use cosfly_diagnose::{Diagnostic, ParameterError};
use cosfly_recipe::{Recipe, read};
use cosfly_stage::{Fan, InputPort, ItemRule, PortSource, Registry, StageKind, StagePart, StageProperties, StageRole};
use std::path::Path;

/// A film of each of its two tracks; part `near` cuts down the tracks at port `others`.
struct Film {
    /// Whether the film requires its part.
    needs_others: bool,
}

impl Film {
    fn properties(&self, inputs: Vec<InputPort>) -> StageProperties {
        StageProperties {
            inputs,
            items: ItemRule::Count { prefix: "t", count: 2 },
            bytes_per_item: 1,
            ..StageProperties::new(self.name(), StageRole::Changes, "track/1")
        }
    }
}

impl StageKind for Film {
    fn name(&self) -> &'static str {
        "film"
    }
    fn doc(&self) -> &'static str {
        "Films tracks."
    }
    fn schema(&self) -> serde_json::Value {
        serde_json::json!({ "type": "object", "properties": {}, "additionalProperties": false })
    }
    fn ports(&self) -> Vec<InputPort> {
        vec![InputPort { optional: true, ..port("others", "track/1", Fan::Gather) }]
    }
    fn build(&self, _: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let near = self.properties(vec![port("others", "track/1", Fan::Gather)]);
        let part = InputPort {
            optional: !self.needs_others,
            source: PortSource::Sibling("near"),
            ..port("near", "track/1", Fan::Each)
        };
        let film = self.properties(vec![part]);
        Ok(vec![
            StagePart { suffix: "near", stage: Box::new(ToyStage(near)) },
            StagePart { suffix: "", stage: Box::new(ToyStage(film)) },
        ])
    }
}

#[expect(clippy::vec_box, reason = "the type of `read`")]
fn checked(needs_others: bool, inputs: &str) -> Result<Recipe, Vec<Box<Diagnostic>>> {
    let text = format!("name = \"t\"\n[stages.first]\nuse = \"film\"\n[stages.second]\nuse = \"film\"\n{inputs}");
    read(Path::new("t.toml"), &text, &[], &Registry::new(vec![Box::new(Film { needs_others })]))
}

fn names(recipe: &Recipe) -> Vec<&str> {
    recipe.stages.iter().map(|stage| stage.name.as_str()).collect()
}

#[test]
fn a_part_without_its_input_is_left_out_and_its_port_is_empty() {
    for inputs in ["", "inputs.others = []"] {
        let recipe = checked(false, inputs).unwrap();
        assert_eq!(names(&recipe), ["first", "second"]);
        assert!(recipe.stages[1].connection("near").is_none());
    }
    let recipe = checked(false, "inputs.others = \"first\"").unwrap();
    assert_eq!(names(&recipe), ["first", "second.near", "second"]);
    assert_eq!(recipe.stages[1].connection("others").unwrap().arrivals_for(0).len(), 2);
    assert_eq!(recipe.stages[2].connection("near").unwrap().arrivals_for(1)[0].stage, 1);
}

#[test]
fn an_input_of_a_part_that_the_stage_requires_is_required() {
    let problems = checked(true, "").unwrap_err();
    let messages: Vec<&str> = problems.iter().map(|problem| problem.message.as_str()).collect();
    assert!(messages.iter().all(|message| message.contains("needs `inputs.others`")), "{messages:?}");
    assert_eq!(messages.len(), 2);
}
