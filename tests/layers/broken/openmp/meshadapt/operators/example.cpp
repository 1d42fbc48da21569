void example() {
#pragma omp parallel
  {}
}
