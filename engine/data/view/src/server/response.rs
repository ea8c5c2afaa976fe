//! An answer, with the headers that all answers have.

use std::io::Write;

/// Rights of the page: it runs its own scripts, and loads from its own server.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// An answer.
#[derive(Clone, Debug)]
pub struct Response {
    status: u16,
    media_type: &'static str,
    body: Vec<u8>,
    cookie: Option<String>,
    is_kept: bool,
}

impl Response {
    /// A file.
    pub fn file(media_type: &'static str, body: impl Into<Vec<u8>>) -> Self {
        Self { status: 200, media_type, body: body.into(), cookie: None, is_kept: false }
    }

    /// A value.
    pub fn json(value: &serde_json::Value) -> Self {
        Self::file("application/json", value.to_string())
    }

    /// A refusal in words.
    pub fn refusal(status: u16, words: &str) -> Self {
        Self { status, ..Self::file("text/plain; charset=utf-8", format!("{words}\n")) }
    }

    /// The answer with another status.
    pub fn with_status(self, status: u16) -> Self {
        Self { status, ..self }
    }

    /// The answer with a cookie.
    pub fn with_cookie(self, cookie: String) -> Self {
        Self { cookie: Some(cookie), ..self }
    }

    /// The answer, which the browser may keep: its address names the version of what is shown.
    pub fn kept(self) -> Self {
        Self { is_kept: true, ..self }
    }

    /// Writes the answer.
    ///
    /// # Errors
    /// The connection is gone.
    pub fn write(&self, stream: &mut impl Write, is_head: bool, stays: bool) -> std::io::Result<()> {
        let mut head = format!(
            "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: {}\r\nCache-Control: {}\r\n\
             Content-Security-Policy: {POLICY}\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
             Cross-Origin-Resource-Policy: same-origin\r\nCross-Origin-Opener-Policy: same-origin\r\nX-Frame-Options: DENY\r\n",
            self.status,
            words(self.status),
            self.media_type,
            self.body.len(),
            if stays { "keep-alive" } else { "close" },
            if self.is_kept { "private, max-age=3600, immutable" } else { "no-store" },
        );
        if let Some(cookie) = &self.cookie {
            head += &format!("Set-Cookie: {cookie}; Path=/; HttpOnly; SameSite=Strict\r\n");
        }
        head += "\r\n";
        let mut bytes = head.into_bytes();
        if !is_head {
            bytes.extend_from_slice(&self.body);
        }
        stream.write_all(&bytes)?;
        stream.flush()
    }
}

fn words(status: u16) -> &'static str {
    match status {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        421 => "Misdirected Request",
        422 => "Unprocessable Content",
        431 => "Request Header Fields Too Large",
        _ => "Service Unavailable",
    }
}
