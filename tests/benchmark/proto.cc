#include "/work/main/tests/support/run_text.h"
#include <crawler/fused/batch.h>
#include <deal.II/base/mpi.h>
#include <chrono>
#include <cstdio>
using namespace crawler;
int main(int argc,char**argv){
  dealii::Utilities::MPI::MPI_InitFinalize guard(argc, argv, 1);
  auto settings = test::wave(-1., 0.4);
  const auto parameters = test::parameters_with(settings);
  const Scene scene = parameters.create_scene();
  unsigned q=atoi(argv[1]), N=atoi(argv[2]), s=atoi(argv[3]); double tol=atof(argv[4]), h0=atof(argv[5]); const char*isa=argc>6?argv[6]:"avx512";
  const bool single = std::string(isa)=="single";
  const LaneEngine&e = single? single_engine(): *batch_engine(isa);
  std::vector<FusedRun> runs(single?1000:8000,{&scene,tol,h0,1e9,100000});
  double best=1e9; std::vector<FusedResult> r;
  for(int i=0;i<5;++i){
  auto t=std::chrono::steady_clock::now();
  r=run_batch({q,N,s},runs,e);
  best=std::min(best,std::chrono::duration<double>(std::chrono::steady_clock::now()-t).count());}
  printf("%s lanes %u: %.0f runs/s; fin %d disp %.12f err %.2e steps %u rej %u newton %lu min %.6f\n",e.instruction_set,e.lanes,runs.size()/best,r[0].finished,r[0].displacement,r[0].displacement/9.0072529800e-2-1,r[0].steps,r[0].rejected_steps,r[0].newton_iterations,r[0].min_stretch);
}
