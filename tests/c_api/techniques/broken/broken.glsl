// Its third line does not compile.
Hit broken_trace(Ray ray) {
  return nothing;
}
