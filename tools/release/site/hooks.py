"""What mkdocs asks while it writes: what the theme's pages lack for people who cannot see or use no
mouse."""

import re

CHANGES = (
    ('role="dialog"', 'role="dialog" aria-label="Search"'),
    # What scrolls has to be reached by keys: code does by its box (style.css), where the theme's
    # script leaves that be.
    ('class="md-search__scrollwrap"', 'class="md-search__scrollwrap" tabindex="0"'),
    ("<pre(?=[ >])", '<pre tabindex="0"'),
    # A corner of a table heads nothing.
    (r"<th([^>]*)></th>", r"<td\1></td>"),
)


def changed(output):
    for old, new in CHANGES:
        output = re.sub(old, new, output)
    return output


def on_post_page(output, page, config):
    return changed(output)


def on_post_template(output_content, template_name, config):
    return changed(output_content) if template_name.endswith(".html") else output_content
