//! Markdown of manifests and experiments as HTML that can do nothing: no HTML of theirs, no pictures, no links but to the web and within the page.

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};

/// Paragraphs, lists, emphasis, code, tables and links. Headings become paragraphs: the page has its own.
pub fn html(markdown: &str) -> String {
    let mut links = Vec::new();
    let events = Parser::new_ext(markdown, Options::ENABLE_TABLES).filter_map(|event| match event {
        Event::Html(text) | Event::InlineHtml(text) => Some(Event::Text(text)),
        Event::Start(Tag::HtmlBlock) => Some(Event::Start(Tag::Paragraph)),
        Event::End(TagEnd::HtmlBlock | TagEnd::Heading(_)) => Some(Event::End(TagEnd::Paragraph)),
        Event::Start(Tag::Heading { .. }) => Some(Event::Start(Tag::Paragraph)),
        Event::Start(Tag::Image { .. }) | Event::End(TagEnd::Image) => None,
        // An info string would become a class.
        Event::Start(Tag::CodeBlock(_)) => Some(Event::Start(Tag::CodeBlock(pulldown_cmark::CodeBlockKind::Fenced(
            CowStr::Borrowed(""),
        )))),
        Event::Start(Tag::Link {
            dest_url, link_type, id, ..
        }) => {
            let is_harmless = ["https://", "http://", "#"].iter().any(|start| dest_url.starts_with(start));
            links.push(is_harmless);
            is_harmless.then_some(Event::Start(Tag::Link {
                link_type,
                dest_url,
                title: CowStr::Borrowed(""),
                id,
            }))
        }
        Event::End(TagEnd::Link) => links.pop().unwrap_or(false).then_some(event),
        other => Some(other),
    });
    let mut text = String::new();
    html::push_html(&mut text, events);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches HTML, scripts, pictures and headings of a manifest in the page.
    #[test]
    fn docs_can_do_nothing() {
        let cases = [
            ("a *b* `c<d>`", "<p>a <em>b</em> <code>c&lt;d&gt;</code></p>\n"),
            (
                "x <img src=x onerror=alert(1)> y",
                "<p>x &lt;img src=x onerror=alert(1)&gt; y</p>\n",
            ),
            ("<script>alert(1)</script>", "<p>&lt;script&gt;alert(1)&lt;/script&gt;</p>\n"),
            (
                "[a](javascript:alert(1)) [b](https://x.y)",
                "<p>a <a href=\"https://x.y\">b</a></p>\n",
            ),
            ("![alt](https://x.y/z.png)", "<p>alt</p>\n"),
            ("# Big\n\n- one\n- two", "<p>Big</p>\n<ul>\n<li>one</li>\n<li>two</li>\n</ul>\n"),
        ];
        for (markdown, expected) in cases {
            assert_eq!(html(markdown), expected, "{markdown}");
        }
    }
}
