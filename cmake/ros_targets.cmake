# Node, nodelets and launch files.
