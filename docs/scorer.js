// Sphinx's own scores; headings that hold the whole question come first, then pages by task.
var Scorer = {
  score: ([page, _title, _anchor, _description, score, _file, kind]) =>
    score + (kind === "title" ? 100 : 0) + (page.startsWith("howto/") ? 20 : 0),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
