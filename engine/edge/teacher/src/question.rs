//! A question: what is sent to a model, and the digest that its answer is kept under.

use crate::config::{JsonMode, TeacherConfig};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use cosfly_fingerprint::{Digest, canonical_json};
use serde_json::{Value, json};

/// Texts and pictures for a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question<'a> {
    /// Standing rules.
    pub system: &'a str,
    /// The question itself.
    pub user: &'a str,
    /// JPEG files.
    pub pictures: &'a [Vec<u8>],
}

/// Estimated bytes of text in a token; few, so that budgets hold.
const BYTES_PER_TOKEN: u64 = 2;
/// Estimated tokens of a picture of 320 pixels.
const TOKENS_PER_PICTURE: u64 = 500;

impl Question<'_> {
    /// Digest of everything that decides an answer; the server's address is no part of it.
    pub fn digest(&self, config: &TeacherConfig) -> Digest {
        let document = json!({
            "schema": "cosfly.question/1",
            "model": config.model,
            "prompt_version": config.prompt_version,
            "temperature": config.temperature,
            "seed": config.seed,
            "max_tokens": config.max_tokens,
            "json": config.json,
            "system": self.system,
            "user": self.user,
            "pictures": self.pictures.iter().map(|file| Digest::of(file).to_string()).collect::<Vec<_>>(),
        });
        Digest::of(canonical_json(&document).as_bytes())
    }

    /// Body of the request.
    pub(crate) fn body(&self, config: &TeacherConfig) -> Vec<u8> {
        let picture = |file: &Vec<u8>| {
            let url = format!("data:image/jpeg;base64,{}", STANDARD.encode(file));
            json!({"type": "image_url", "image_url": {"url": url}})
        };
        let content = if self.pictures.is_empty() {
            Value::from(self.user)
        } else {
            self.pictures.iter().map(picture).chain([json!({"type": "text", "text": self.user})]).collect()
        };
        let mut body = json!({
            "model": config.model,
            "temperature": config.temperature,
            "seed": config.seed,
            "max_tokens": config.max_tokens,
            "stream": false,
            "messages": [{"role": "system", "content": self.system}, {"role": "user", "content": content}],
        });
        match config.json {
            JsonMode::Schema => body["response_format"] = answer_schema(),
            JsonMode::Object => body["response_format"] = json!({"type": "json_object"}),
            JsonMode::ObjectSchema => {
                let schema = answer_schema()["json_schema"]["schema"].take();
                body["response_format"] = json!({"type": "json_object", "schema": schema});
            }
            JsonMode::Text => {}
        }
        body.to_string().into_bytes()
    }

    /// Estimated tokens of the question, rather too many.
    pub fn estimated_tokens(&self) -> u64 {
        let bytes = (self.system.len() + self.user.len()) as u64;
        bytes / BYTES_PER_TOKEN + TOKENS_PER_PICTURE * self.pictures.len() as u64 + 20
    }
}

/// Form of an answer: an object with one text.
fn answer_schema() -> Value {
    let schema = json!({
        "type": "object",
        "properties": {"text": {"type": "string"}},
        "required": ["text"],
        "additionalProperties": false,
    });
    json!({"type": "json_schema", "json_schema": {"name": "text", "strict": true, "schema": schema}})
}
