"""What mkdocs asks while it writes: what the theme's pages lack for people who cannot see or use no mouse."""

NAMES = (
    ('role="dialog"', 'role="dialog" aria-label="Search"'),
    # What scrolls has to be reached by keys.
    ('class="md-search__scrollwrap"', 'class="md-search__scrollwrap" tabindex="0"'),
    ("<pre><span></span><code>", '<pre><span></span><code tabindex="0">'),
    ("<pre><code>", '<pre><code tabindex="0">'),
)


def named(output):
    for old, new in NAMES:
        output = output.replace(old, new)
    return output


def on_post_page(output, page, config):
    return named(output)


def on_post_template(output_content, template_name, config):
    return named(output_content) if template_name.endswith(".html") else output_content
