//! As much of HTTP/1.1 (RFC 9112) as a browser needs to load files from its own machine.

use std::borrow::Cow;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::Duration;

/// Longest head of a request, bytes.
const MOST: u64 = 16 << 10;
/// A browser opens connections that it may need later; they are not waited for longer than this.
const PATIENCE: Duration = Duration::from_secs(10);

/// An answer.
#[derive(Clone, Debug)]
pub struct Response<'b> {
    /// As HTTP counts them.
    pub status: u16,
    /// Media type.
    pub kind: Cow<'b, str>,
    /// Contents.
    pub body: Cow<'b, [u8]>,
}

impl<'b> Response<'b> {
    /// There is no such thing.
    pub const MISSING: Self = Self {
        status: 404,
        kind: Cow::Borrowed("text/plain"),
        body: Cow::Borrowed(b"not found"),
    };

    /// This was asked for.
    pub fn found(kind: &'b str, body: impl Into<Cow<'b, [u8]>>) -> Self {
        Self {
            status: 200,
            kind: kind.into(),
            body: body.into(),
        }
    }
}

/// Answers requests for ever, each connection's in a thread of its own. `respond` is given the path with its query.
pub fn serve<'b>(listener: &TcpListener, respond: impl Fn(&str) -> Response<'b> + Sync) {
    std::thread::scope(|scope| {
        for stream in listener.incoming() {
            let respond = &respond;
            let answered = stream.and_then(|stream| {
                std::thread::Builder::new().spawn_scoped(scope, move || {
                    if let Err(error) = answer(&stream, respond) {
                        log::debug!("{error}");
                    }
                })
            });
            if let Err(error) = answered {
                log::warn!("{error}");
            }
        }
    });
}

fn answer<'b>(mut stream: &TcpStream, respond: impl Fn(&str) -> Response<'b>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut head = BufReader::new(stream.take(MOST)).lines();
    let first = head.next().unwrap_or_else(|| Ok(String::new()))?;
    // The rest says nothing that matters here, but a browser wants to be heard out.
    for line in head {
        if line?.is_empty() {
            break;
        }
    }
    let mut words = first.split_whitespace();
    let (method, path) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let response = match method {
        "GET" | "HEAD" => respond(path),
        _ => Response {
            status: 405,
            ..Response::MISSING
        },
    };
    let Response { status, kind, body } = response;
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status} \r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: no-cache\r\nConnection: close\r\n\r\n"
    )?;
    if method != "HEAD" {
        stream.write_all(&body)?;
    }
    stream.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches an answer that a browser cannot read, and a request that ends the server.
    #[test]
    fn requests_are_answered() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        // It serves until the test's process ends.
        std::thread::spawn(move || serve(&listener, |path| Response::found("text/x", path.as_bytes().to_vec())));
        let ask = |request: &[u8]| {
            let mut stream = TcpStream::connect(address).unwrap();
            stream.write_all(request).unwrap();
            stream.shutdown(std::net::Shutdown::Write).unwrap();
            let mut answer = String::new();
            stream.read_to_string(&mut answer).unwrap();
            answer
        };
        let wanted =
            "HTTP/1.1 200 \r\nContent-Type: text/x\r\nContent-Length: 6\r\nCache-Control: no-cache\r\nConnection: close\r\n\r\n/a?b=c";
        assert_eq!(ask(b"GET /a?b=c HTTP/1.1\r\nHost: x\r\n\r\n"), wanted);
        assert_eq!(ask(b"HEAD /a?b=c HTTP/1.1\r\n\r\n"), wanted.trim_end_matches("/a?b=c"));
        assert!(ask(b"POST / HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 405 "));
        for odd in [&b""[..], b"\r\n\r\n", b"\xff\xfe\r\n\r\n", b"GET", &[b'x'; 20_000]] {
            drop(ask_quietly(address, odd));
        }
        assert_eq!(ask(b"GET /a?b=c HTTP/1.1\r\n\r\n"), wanted);
    }

    /// What is no request may be answered in any way, or not at all.
    fn ask_quietly(address: std::net::SocketAddr, request: &[u8]) -> io::Result<Vec<u8>> {
        let mut stream = TcpStream::connect(address)?;
        stream.write_all(request)?;
        stream.shutdown(std::net::Shutdown::Write)?;
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer)?;
        Ok(answer)
    }
}
