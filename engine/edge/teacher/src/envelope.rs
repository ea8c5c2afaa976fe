//! Reads the JSON around an answer, as servers of the protocol send it.

use serde_json::Value;

/// Larger bodies are not read: an answer is a few sentences.
pub const MOST_BYTES: u64 = 1 << 20;
/// Longer texts are cut: no answer that could be accepted is as long.
const MOST_TEXT: usize = 16 << 10;

/// Response of a server, taken apart.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Envelope {
    pub content: String,
    pub served_model: String,
    pub finish: String,
    pub input_tokens: Option<u64>,
    pub output_tokens: Option<u64>,
}

impl Envelope {
    /// Reads a body; `None` where it is no answer of the protocol, such as one that was cut.
    pub fn read(body: &[u8]) -> Option<Self> {
        let value: Value = serde_json::from_slice(body).ok()?;
        let choice = value.get("choices")?.get(0)?;
        let short = |value: Option<&Value>, most: usize| {
            let text = value.and_then(Value::as_str).unwrap_or_default();
            text.chars().take(most).collect::<String>()
        };
        let tokens = |name: &str| value.get("usage").and_then(|usage| usage.get(name)).and_then(Value::as_u64);
        Some(Self {
            content: short(choice.get("message")?.get("content"), MOST_TEXT),
            served_model: short(value.get("model"), 200),
            finish: short(choice.get("finish_reason"), 40),
            input_tokens: tokens("prompt_tokens"),
            output_tokens: tokens("completion_tokens"),
        })
    }
}
