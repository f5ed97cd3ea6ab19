// A second file, to be found by #include: a lower surface is a higher ray.
Ray template_technique_biased(Ray ray) {
  ray.origin.z += template_technique_bias;
  return ray;
}
