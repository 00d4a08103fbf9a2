// Wide tables scroll in boxes that the theme's script puts around them: to be reached by keys, too.
window.addEventListener('load', () => {
  for (const box of document.querySelectorAll('.md-typeset__scrollwrap')) box.tabIndex = 0;
});
