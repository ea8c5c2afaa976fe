//! The Responsible AI terms: what was simulated, how it was checked, what it is for and what it is not.

use crate::publish::summary::Summary;
use cosfly_diagnose::counted;
use cosfly_schema::config::{DatasetConfig, RESPONSIBLE_AI_TERMS};
use serde_json::{Map, Value, json};

/// All terms as properties of the document.
pub fn values(config: &DatasetConfig, summary: &Summary) -> Map<String, Value> {
    let mut values = Map::new();
    for term in RESPONSIBLE_AI_TERMS {
        let value = match config.responsible_ai.get(term) {
            Some(text) => json!(text),
            None => default_value(term, config, summary),
        };
        values.insert(format!("rai:{term}"), value);
    }
    values.insert("rai:hasSyntheticData".into(), json!(true));
    values
}

fn default_value(term: &str, config: &DatasetConfig, summary: &Summary) -> Value {
    match term {
        "dataCollectionType" => json!(["Software Collection", "Experiments"]),
        "dataCollectionTimeframe" => json!([config.date_published, config.date_published]),
        "annotationsPerItem" => json!("1"),
        "dataCollectionMissingData" => json!(format!(
            "{} got no flight or no film; table rejected gives the reason of each.",
            counted(summary.rejected, "item")
        )),
        "dataBiases" => json!([
            "Pedestrians, vehicles, weather and camera motion are those of a simulator: street layouts of a few towns, \
             few shapes of bodies, people who walk or stand, presets of weather.",
            "Expert flights weigh distance, view, smoothness and safety as the weights of their planner say. With \
             the default weights nothing keeps them behind the target, which is seen from any side; \
             mean_rear_angle_deg and mean_distance_m of table trajectories say how each one flew.",
        ]),
        "dataLimitations" => json!([
            "Images are rendered with procedural materials; networks trained on them alone will meet a gap to real cameras.",
            "Flights are checked against the geometry and against limits of speed, acceleration and jerk, not against \
             the dynamics of a particular drone.",
        ]),
        "dataUseCases" => json!([
            "Training and validation of drones that keep a moving person in view: imitation, recovery from \
             disturbances, vision-language-action models, planning with occlusion.",
            "Not for unauthorised surveillance, not for the identification of persons, not for weapons.",
        ]),
        _ => json!(text(term)),
    }
}

fn text(term: &str) -> &'static str {
    match term {
        "annotatorDemographics" => "None: no person annotated anything.",
        "dataAnnotationAnalysis" => {
            "Stored boxes are compared with the reprojected body and with the label and instance images; every number \
             and direction in a caption is compared with the facts of its flight."
        }
        "dataAnnotationPlatform" => "None; cosfly computes all labels.",
        "dataAnnotationProtocol" => {
            "Labels are exact results of the simulation: poses, planar depth, label and instance ids per pixel, \
             visibility by rays and by pixels, boxes, captions from templates filled with facts of the flight."
        }
        "dataCollection" => {
            "People walk simulated routes on the walkable ground of a town, vehicles drive on its lanes; an optimiser plans the drone's \
             flight behind each of them; a perturbed twin departs from it at random and returns; a renderer makes the \
             images of every frame."
        }
        "dataCollectionRawData" => {
            "Map files of towns, or towns made by a seeded generator; recorded walks where the recipe reads them."
        }
        "dataImputationProtocol" => "None: no value is imputed.",
        "dataManipulationProtocol" => {
            "Depth may be rounded to a grid of 2^-10 m and colour images may be JPEG compressed; the logs say which."
        }
        "dataPreprocessingProtocol" => {
            "Routes are smoothed and resampled at a fixed time step; obstacles are simplified for planning but never \
             for certificates, visibility or images."
        }
        "dataReleaseMaintenancePlan" => {
            "The same recipe and version of cosfly give the same bytes. A change of the last version number packages \
             the same data anew, of the middle one adds records, of the first one changes or moves records."
        }
        "dataSocialImpact" => {
            "Tracking of persons from the air helps in search and rescue, filming and escorting, and can be abused \
             for surveillance. No picture shows a real person."
        }
        "machineAnnotationTools" => "cosfly",
        "personalSensitiveInformation" => {
            "No picture shows a real person: all people are drawn figures. Their walks are simulated; where the recipe reads \
             recorded walks, they are tracks of real people without names. A town from a map of a real place can be \
             recognised."
        }
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_says_something() {
        let values = values(&DatasetConfig::default(), &Summary::default());
        assert_eq!(values.len(), RESPONSIBLE_AI_TERMS.len() + 1);
        for (term, value) in &values {
            assert!(*value != json!("") && !value.is_null(), "{term}");
        }
    }
}
